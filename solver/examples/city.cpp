// The city: a rainy evening in an old business quarter. Wet slate-blue streets, pale stone blocks
// with shops below and lit windows above, brick houses under slate gables, a park with a fountain.
// Heights, streets and parks are drawn in the plan below; city_layout.h says what its letters mean.

#include "solver/examples/built_in.h"
#include "solver/examples/city_blocks.h"
#include "solver/examples/city_ground.h"
#include "solver/examples/city_houses.h"
#include "solver/examples/city_layout.h"
#include "solver/examples/city_roofs.h"
#include "solver/examples/example_builder.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::examples {

namespace {

constexpr int kFloorCount = 10;

std::vector<std::string_view> plan() {
    return {
        "........#.........",  //
        ".3355.aa#t.tl.....",  //
        ".3355.aa###k=#....",  //
        "t3355laa#7744#ggg.",  //
        "=####=#z#7744#gSg.",  //
        "t66#DDDD#77.t=ggg.",  //
        ".66=DDDD#22.n#bbb.",  //
        ".66#DDDDz22ltzbbbt",  //
        "#kz##=#z#z##z#z=##",  //
        ".cc#ggggz88..DDDDl",  //
        ".cc#gTOg#88.nDDDD.",  //
        ".cc=ggTg=88.tDDDD.",  //
        "..t#ggggzt...DDDD.",  //
        "...##=#z#...n..t..",  //
        "...EEEEE#aaaa..p..",  //
        ".p.EEEEE=aaaa.....",  //
        "...EEEEE#...t.....",  //
        "...t....#.........",  //
    };
}

CityMaterials add_materials(ExampleBuilder& builder) {
    CityMaterials m;
    m.asphalt = builder.add_material({"asphalt", srgb(0x39414D), 0, 0.45F});
    m.paving = builder.add_material({"paving", srgb(0x818B9A), 0, 0.6F});
    m.stone = builder.add_material({"stone", srgb(0xC2B5A0), 0, 0.85F});
    m.brick = builder.add_material({"brick", srgb(0x9C5140), 0, 0.9F});
    m.slate = builder.add_material({"slate", srgb(0x4A5C74), 0, 0.6F});
    m.glass = builder.add_material({"glass", srgb(0x223A4C), 0, 0.2F});
    m.glow = builder.add_material({"glow", srgb(0xFFC97A), 0, 0.6F, srgb(0xF2A23C)});
    m.leaf = builder.add_material({"leaf", srgb(0x4E7F52), 0, 0.9F});
    m.accent = builder.add_material({"accent", srgb(0x2E8F93), 0, 0.7F});
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

OpenLetters add_open(PieceAdder& add, const CityMaterials& m) {
    OpenLetters open;
    open.air = add.empty("air");
    open.paving = add.single("paving", make_paving(m, PavingPart::kNone));
    open.lamp = add.single("paving_lamp", make_paving(m, PavingPart::kLamp));
    open.tree = add.single("paving_tree", make_paving(m, PavingPart::kTree));
    open.bench = add.single("paving_bench", make_paving(m, PavingPart::kBench));
    open.puddle = add.single("paving_puddle", make_paving(m, PavingPart::kPuddle));
    open.lawn = add.single("lawn", make_lawn(m, LawnPart::kNone));
    open.lawn_edge = add.turned("lawn_edge", make_lawn_edge(m));
    open.lawn_corner = add.turned("lawn_corner", make_lawn_corner(m));
    open.lawn_tree = add.single("lawn_tree", make_lawn(m, LawnPart::kTree));
    open.lawn_shrubs = add.single("lawn_shrubs", make_lawn(m, LawnPart::kShrubs));
    open.fountain = add.single("fountain", make_lawn(m, LawnPart::kFountain));
    return open;
}

StreetLetters add_streets(PieceAdder& add, const CityMaterials& m) {
    StreetLetters street;
    street.plain = add.axial("street", make_straight(m, StreetPart::kMarking));
    street.lamps = add.axial("street_lamps", make_straight(m, StreetPart::kLamps));
    street.zebra = add.axial("street_zebra", make_straight(m, StreetPart::kZebra));
    street.car = add.axial("street_car", make_straight(m, StreetPart::kCar));
    street.crossing = add.single("street_crossing", make_street(m, kArmsCrossing));
    street.fork = add.turned("street_fork", make_street(m, kArmsFork));
    street.turn = add.turned("street_turn", make_street(m, kArmsTurn));
    return street;
}

BlockLetters add_blocks(PieceAdder& add, const CityMaterials& m) {
    BlockLetters block;
    block.shop = add.turned("shop", make_shop(m));
    block.door = add.turned("block_door", make_block_door(m));
    block.ground_corner = add.turned("shop_corner", make_shop_corner(m));
    block.ground_core = add.single("ground_core", make_core(m));
    block.wall = add.turned("block_wall", make_block_wall(m, false));
    block.lit_wall = add.turned("block_wall_lit", make_block_wall(m, true));
    block.corner = add.turned("block_corner", make_block_corner(m));
    block.brick_wall = add.turned("loft_wall", make_loft_wall(m, false));
    block.lit_brick_wall = add.turned("loft_wall_lit", make_loft_wall(m, true));
    block.brick_corner = add.turned("loft_corner", make_loft_corner(m));
    block.core = add.single("core", make_core(m));
    block.terrace = add.turned("terrace", make_terrace_wall(m));
    block.terrace_left = add.turned("terrace_left", make_terrace_corner(m, true));
    block.terrace_right = add.turned("terrace_right", make_terrace_corner(m, false));
    block.parapet = add.turned("parapet", make_parapet(m, false));
    block.parapet_corner = add.turned("parapet_corner", make_parapet_corner(m, false));
    block.parapet_tank = add.turned("parapet_corner_tank", make_parapet_corner(m, true));
    block.parapet_stack = add.turned("parapet_stack", make_parapet(m, true));
    block.roof = add.single("roof", make_flat_roof(m, RoofPart::kNone));
    block.roof_tank = add.single("roof_tank", make_flat_roof(m, RoofPart::kTank));
    block.roof_mast = add.single("roof_mast", make_flat_roof(m, RoofPart::kMast));
    block.roof_light = add.single("roof_light", make_flat_roof(m, RoofPart::kLight));
    return block;
}

HouseLetters add_houses(PieceAdder& add, const CityMaterials& m) {
    HouseLetters house;
    house.front = add.turned("house_front", make_house_front(m));
    house.door = add.turned("house_door", make_house_door(m));
    house.ground_corner = add.turned("house_ground_corner", make_house_ground_corner(m));
    house.wall = add.turned("house_wall", make_house_wall(m));
    house.corner = add.turned("house_corner", make_house_corner(m));
    house.slope = add.turned("slope", make_slope(m, false));
    house.dormer = add.turned("slope_dormer", make_slope(m, true));
    house.gable_left = add.turned("gable_left", make_gable(m, true));
    house.gable_right = add.turned("gable_right", make_gable(m, false));
    return house;
}

// The city ends in open places, so that no building is cut. Streets run out of it only where they
// have lamps: anything else and every second cell of the rim would begin a street.
discrete::Boundary boundary() {
    const std::vector<std::string> open = {
        "air",
        "paving",
        "paving_lamp",
        "paving_tree",
        "paving_bench",
        "paving_puddle",
        "street_lamps_x",
        "street_lamps_z"};
    const discrete::SideBoundary rim = {discrete::BoundaryKind::kPieces, open};
    const discrete::SideBoundary top = {discrete::BoundaryKind::kPieces, {"air"}};
    const discrete::SideBoundary bottom = {discrete::BoundaryKind::kExample, {}};
    return {rim, rim, top, bottom, rim, rim};
}

// How much more or less often than in the plan a piece is drawn. Turned pieces are named without
// their side, or with it where sides differ: the search comes from the north-west, so what has its
// north-western corner drawn more often begins more often without ending sooner.
struct Tuning {
    std::string_view name;
    double weight;
};

constexpr Tuning kTunings[] = {
    {"paving", 0.095},
    {"paving_lamp", 0.3},
    {"paving_tree", 0.4},
    {"paving_bench", 0.3},
    {"paving_puddle", 0.3},
    {"street_car", 2},
    {"street_fork", 1.6},
    {"street_crossing", 2.5},
    {"street_turn_s", 8},
    {"shop_corner", 0.45},
    {"shop_corner_n", 1.2},
    {"house_ground_corner", 0.6},
    {"house_ground_corner_n", 1.4},
    {"house_corner", 0.5},
    {"roof", 1.5},
    {"roof_tank", 0.7},
    {"roof_light", 0.7},
    {"roof_mast", 0.5},
    {"parapet_stack", 0.7},
    {"parapet_corner_tank", 0.35},
    {"block_corner", 0.8},
    {"loft_corner", 1.7},
    {"lawn_corner_n", 6},
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
    letters.open = add_open(add, materials);
    letters.street = add_streets(add, materials);
    letters.block = add_blocks(add, materials);
    letters.house = add_houses(add, materials);
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
