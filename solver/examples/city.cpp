// The city: an old town on a sunny morning. Cream and brick blocks with shops below, pastel houses
// with gardens under terracotta gables, lanes, squares and parks in a net of streets, and a clock
// tower. Heights, streets and parks are drawn in the plan below; city_layout.h says what its
// letters mean.

#include "solver/examples/built_in.h"
#include "solver/examples/city_blocks.h"
#include "solver/examples/city_ground.h"
#include "solver/examples/city_houses.h"
#include "solver/examples/city_layout.h"
#include "solver/examples/city_places.h"
#include "solver/examples/city_roofs.h"
#include "solver/examples/city_tower.h"
#include "solver/examples/example_builder.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::examples {

namespace {

constexpr int kFloorCount = 10;

// Junctions are four cells apart or more, lots three cells deep: that is what keeps the streets of
// a model from curling up.
std::vector<std::string_view> plan() {
    return {
        "######################",  //
        "#aaa:444#bbbb:KKK:ppp#",  //
        "#aaa:444#bbbb:KKK:ppp#",  //
        "#ggg:444#gggg:KKK:ppp#",  //
        "#ggg::::##############",  //
        "#bbb:CCC#vvvv:555yqqq#",  //
        "#bbb:CCC#MMMM:555yqqq#",  //
        "#vvv:CCC#MMMM:555yqqq#",  //
        "#########MMMM::::yyyy#",  //
        "#gcc#qqq#yyyyy::::111#",  //
        "#gcc#qqq#ppppygbb:111#",  //
        "#gcc#qqq#ppppygbb:111#",  //
        "#gcc#qqq#ppppygbbyyyy#",  //
        "#gcc#222######gbby####",  //
        "#:::#222#DDDD#gbbyyyy#",  //
        "#vtt#222#DDDD#gbbyJJJ#",  //
        "#vtt#222#DDDD#gbbyJJJ#",  //
        "##############:::yJJJ#",  //
        "#333:ggg#ccc:AAAAyJJJ#",  //
        "#333:aaa#ccc:AAAAyJJJ#",  //
        "#333:aaa#ggg:AAAA:vvv#",  //
    };
}

CityMaterials add_materials(ExampleBuilder& builder) {
    CityMaterials m;
    const auto add = [&](const char* name, std::uint32_t hex, float roughness) {
        return builder.add_material({name, srgb(hex), 0, roughness});
    };
    m.asphalt = add("asphalt", 0xABAFB6, 0.9F);
    m.paving = add("paving", 0xEBDFCB, 0.85F);
    m.stone = add("stone", 0xF6E7CB, 0.85F);
    m.plaster = add("plaster", 0xF7F1E4, 0.9F);
    m.ochre = add("ochre", 0xF7CB80, 0.9F);
    m.mint = add("mint", 0xB4DFC8, 0.9F);
    m.brick = add("brick", 0xE48C6C, 0.9F);
    m.wood = add("wood", 0x9A6B48, 0.9F);
    m.tile = add("tile", 0xF28547, 0.8F);
    m.slate = add("slate", 0x8DB2D8, 0.8F);
    m.glass = add("glass", 0x95C4E4, 0.3F);
    m.leaf = add("leaf", 0x9FD350, 0.9F);
    m.accent = add("accent", 0x38AABB, 0.7F);
    m.iron = add("iron", 0x68727C, 0.7F);
    m.glow = builder.add_material({"glow", srgb(0xFFDF9E), 0, 0.6F, srgb(0x6A5630)});
    return m;
}

// Adds pieces and hands out their letters: there are more labels than letters one can read, and
// the plan needs none of them.
class PieceAdder {
  public:
    explicit PieceAdder(ExampleBuilder& builder) : builder_(builder) {}

    char empty(const std::string& name) {
        builder_.add_empty(next_letter(), name);
        return letter_;
    }

    char single(const std::string& name, MeshBuilder mesh, double weight = 1) {
        builder_.add_piece(next_letter(), name, std::move(mesh), weight);
        return letter_;
    }

    Turned turned(const std::string& name, MeshBuilder mesh, double weight = 1) {
        Turned letters;
        for (char& letter : letters) {
            letter = next_letter();
        }
        builder_.add_turned({letters.data(), letters.size()}, name, std::move(mesh), weight);
        return letters;
    }

    Axial axial(const std::string& name, MeshBuilder mesh, double weight = 1) {
        Axial letters;
        for (char& letter : letters) {
            letter = next_letter();
        }
        builder_.add_axial({letters.data(), letters.size()}, name, std::move(mesh), weight);
        return letters;
    }

  private:
    char next_letter() { return ++letter_; }

    ExampleBuilder& builder_;
    char letter_ = 0;
};

StreetLetters add_streets(PieceAdder& add, const CityMaterials& m) {
    StreetLetters street;
    street.plain = add.axial("street", make_straight(m, StreetPart::kMarking));
    street.lamps = add.axial("street_lamps", make_straight(m, StreetPart::kLamps));
    street.car = add.axial("street_cars", make_straight(m, StreetPart::kCar));
    street.zebra = add.turned("street_zebra", make_straight(m, StreetPart::kZebra));
    street.crossing = add.single("street_crossing", make_street(m, kArmsCrossing));
    street.fork = add.turned("street_fork", make_street(m, kArmsFork));
    street.end = add.turned("street_end", make_street_end(m));
    street.turn = add.turned("street_turn", make_street(m, kArmsTurn));
    return street;
}

LaneLetters add_lanes(PieceAdder& add, const CityMaterials& m) {
    LaneLetters lane;
    lane.plain = add.axial("lane", make_lane(m, LanePart::kNone));
    lane.tree = add.axial("lane_tree", make_lane(m, LanePart::kTree));
    lane.yard = add.single("yard", make_lane(m, LanePart::kDrain));
    lane.yard_tree = add.single("yard_tree", make_lane(m, LanePart::kBigTree));
    lane.yard_bench = add.single("yard_bench", make_lane(m, LanePart::kBench));
    lane.verge = add.turned("verge", make_verge(m));
    return lane;
}

PlaceLetters add_park(PieceAdder& add, const CityMaterials& m) {
    PlaceLetters park;
    park.edge = add.turned("park_edge", make_lawn_edge(m));
    park.corner = add.turned("park_corner", make_lawn_corner(m));
    park.middle = add.axial("park_tree", make_lawn(m, LawnPart::kTree));
    park.feature = add.single("park_flowers", make_lawn(m, LawnPart::kFlowers));
    return park;
}

PlaceLetters add_square(PieceAdder& add, const CityMaterials& m) {
    PlaceLetters square;
    square.edge = add.turned("square_edge", make_square_edge(m));
    square.corner = add.turned("square_corner", make_square_corner(m));
    square.middle = add.axial("square_stall", make_square_middle(m, false));
    square.feature = add.single("square_fountain", make_square_middle(m, true));
    return square;
}

BlockLetters add_blocks(PieceAdder& add, const CityMaterials& m) {
    BlockLetters block;
    block.shop = add.turned("shop", make_shop(m));
    block.ground_corner = add.turned("shop_corner", make_shop_corner(m));
    block.ground_core = add.axial("ground_core", make_core(m));
    block.wall = add.turned("block_wall", make_block_wall(m, m.stone, false));
    block.balcony = add.turned("block_balcony", make_block_wall(m, m.stone, true));
    block.corner = add.turned("block_corner", make_block_corner(m, m.stone));
    block.mint_wall = add.turned("mint_wall", make_block_wall(m, m.mint, false));
    block.mint_corner = add.turned("mint_corner", make_block_corner(m, m.mint));
    block.brick_wall = add.turned("loft_wall", make_loft_wall(m));
    block.brick_corner = add.turned("loft_corner", make_loft_corner(m));
    block.core = add.single("core", make_core(m));
    block.mansard = add.turned("mansard", make_mansard(m, m.slate, false));
    block.mansard_corner = add.turned("mansard_corner", make_mansard_corner(m, m.slate));
    block.tile_mansard = add.turned("tile_mansard", make_mansard(m, m.tile, false));
    block.tile_mansard_corner = add.turned("tile_mansard_corner", make_mansard_corner(m, m.tile));
    block.mansard_dormer = add.turned("mansard_dormer", make_mansard(m, m.slate, true));
    block.roof = add.single("roof", make_flat_roof(m, RoofPart::kHatch));
    block.roof_cupola = add.single("roof_cupola", make_flat_roof(m, RoofPart::kCupola));
    block.roof_garden = add.single("roof_garden", make_flat_roof(m, RoofPart::kGarden));
    block.roof_light = add.single("roof_light", make_flat_roof(m, RoofPart::kLight));
    return block;
}

HouseLetters add_houses(PieceAdder& add, const CityMaterials& m) {
    HouseLetters house;
    house.front = add.turned("house_front", make_house_door(m));
    house.back = add.turned("house_back", make_house_front(m));
    house.ground_corner = add.turned("house_ground_corner", make_house_ground_corner(m));
    house.garden = add.turned("garden", make_garden(m, GardenEnd::kNone));
    house.garden_left = add.turned("garden_left", make_garden(m, GardenEnd::kLeft));
    house.garden_right = add.turned("garden_right", make_garden(m, GardenEnd::kRight));
    house.wall = add.turned("house_wall", make_house_wall(m, HouseStorey::kMiddle));
    house.corner = add.turned("house_corner", make_house_corner(m, HouseStorey::kMiddle));
    house.timber_wall = add.turned("timber_wall", make_house_wall(m, HouseStorey::kTimber));
    house.timber_corner = add.turned("timber_corner", make_house_corner(m, HouseStorey::kTimber));
    house.slope = add.turned("slope", make_slope(m, false));
    house.dormer = add.turned("slope_dormer", make_slope(m, true));
    house.gable_left = add.turned("gable_left", make_gable(m, true));
    house.gable_right = add.turned("gable_right", make_gable(m, false));
    return house;
}

TowerLetters add_tower(PieceAdder& add, const CityMaterials& m) {
    TowerLetters tower;
    tower.ground = add.turned("tower_ground", make_tower_ground(m));
    tower.shaft = add.turned("tower_shaft", make_tower_shaft(m));
    tower.belfry = add.turned("tower_belfry", make_tower_belfry(m));
    tower.spire = add.turned("tower_spire", make_tower_spire(m));
    return tower;
}

// The city ends at a ring road, so that no building is cut.
discrete::Boundary boundary() {
    const auto ring = [](const char* axis, std::initializer_list<const char*> others) {
        discrete::SideBoundary side = {discrete::BoundaryKind::kPieces, {"air"}};
        for (const char* name : {"street_", "street_lamps_", "street_cars_"}) {
            side.pieces.push_back(std::string(name) + axis);
        }
        side.pieces.insert(side.pieces.end(), others.begin(), others.end());
        return side;
    };
    // A turn is named by the first of its arms, a fork by the side where it has none.
    return {
        ring(
            "z",
            {"street_zebra_n", "street_zebra_s", "street_fork_e", "street_turn_n", "street_turn_w"}
        ),
        ring(
            "z",
            {"street_zebra_n", "street_zebra_s", "street_fork_w", "street_turn_e", "street_turn_s"}
        ),
        discrete::SideBoundary{discrete::BoundaryKind::kPieces, {"air"}},
        discrete::SideBoundary{discrete::BoundaryKind::kExample, {}},
        ring(
            "x",
            {"street_zebra_e", "street_zebra_w", "street_fork_s", "street_turn_e", "street_turn_n"}
        ),
        ring(
            "x",
            {"street_zebra_e", "street_zebra_w", "street_fork_n", "street_turn_w", "street_turn_s"}
        )};
}

// How much more or less often than in the plan a piece is drawn. Turned pieces are named without
// their side, or with it where sides differ: the search comes from the north-west, so what begins
// there begins anew, and what ends there goes on with what is there already.
struct Tuning {
    std::string_view name;
    double weight;
};

constexpr Tuning kTunings[] = {
    // Streets, and what only fills gaps.
    {"street_zebra_e", 6},
    {"street_zebra_s", 6},
    {"street_fork_n", 2},
    {"street_fork_w", 2},
    {"street_crossing", 2},
    {"street_turn_s", 0.02},
    {"street_end_n", 0.08},
    {"street_end_w", 0.08},
    {"street_end_e", 0.0005},
    {"street_end_s", 0.0005},
    {"yard", 0.0005},
    {"yard_tree", 0.0006},
    {"yard_bench", 0.0006},
    {"lane", 0.05},
    {"lane_tree", 0.05},
    {"verge", 0.1},
    {"verge_e", 0.03},
    // What begins in the north-west: how many lots there are of each kind.
    {"shop_corner_n", 2},
    {"house_ground_corner_n", 26},
    {"garden_left", 15},
    {"garden_right", 15},
    {"park_corner_n", 40},
    {"square_corner_n", 32},
    // Long houses look like barracks.
    {"house_front", 0.4},
    {"house_back", 0.4},
    // How high they rise.
    {"mansard_corner_n", 0.9},
    {"tile_mansard_corner_n", 0.85},
    {"mint_corner_n", 1.3},
    {"loft_corner_n", 1.2},
    {"tower_belfry_n", 2.5},
};

void tune(discrete::Example& example) {
    for (discrete::Piece& piece : example.pieces) {
        for (const Tuning& tuning : kTunings) {
            const std::string_view name = piece.name;
            const bool is_turn_of = name.size() == tuning.name.size() + 2 &&
                                    name.starts_with(tuning.name) &&
                                    name[tuning.name.size()] == '_';
            if (name == tuning.name || is_turn_of) {
                piece.weight = tuning.weight;
            }
        }
    }
}

}  // namespace

discrete::Example make_city() {
    constexpr double kWidth_m = 2 * double{kCityHalf};
    ExampleBuilder builder("city", kWidth_m, double{kCityStorey}, kWidth_m);
    const CityMaterials materials = add_materials(builder);
    PieceAdder add(builder);
    CityLetters letters;
    letters.air = add.empty("air");
    letters.street = add_streets(add, materials);
    letters.lane = add_lanes(add, materials);
    letters.park = add_park(add, materials);
    letters.square = add_square(add, materials);
    letters.block = add_blocks(add, materials);
    letters.house = add_houses(add, materials);
    letters.tower = add_tower(add, materials);
    for (std::vector<std::string>& rows : lay_out_city(plan(), kFloorCount, letters)) {
        builder.add_floor(std::move(rows));
    }
    builder.set_boundary(boundary());
    builder.set_default_size({40, kFloorCount, 40});
    discrete::Example example = std::move(builder).build();
    tune(example);
    return example;
}

}  // namespace modelsynth::examples
