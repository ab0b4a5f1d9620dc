#include "solver/examples/built_in.h"
#include "solver/examples/canyon_cliffs.h"
#include "solver/examples/canyon_landmarks.h"
#include "solver/examples/canyon_props.h"
#include "solver/examples/canyon_spires.h"
#include "solver/examples/canyon_terrain.h"
#include "solver/examples/example_builder.h"

#include <array>
#include <utility>

// A red canyon in morning light: mesas and terraces of layered sandstone about turquoise streams,
// with natural arches, hoodoos, stairs cut into the rock, rope bridges and houses of mud brick on
// top.
//
// Rock is told by the corners of cells: a cell's corners reach one or two heights, and where they
// reach two a line between rock and air runs through it. So cliffs come as edges, corners and
// nooks in four turns, for the foot of a cliff, its middle, its rim and the foot of a mesa that
// stands on another. What lies inside is "rock", which is not drawn.

namespace modelsynth::examples {

namespace {

// Letters of the pieces that come in turns, east north west south.
constexpr const char* kStreamBend = "1234";  // from north to east, and so on round
constexpr const char* kPool = "5678";        // open to the ...
constexpr const char* kHouse = "abde";
constexpr const char* kSpring = "EFGH";
constexpr const char* kStair = "IJKL";
constexpr const char* kStairHead = "MNOP";
constexpr const char* kTerraceStair = "QRST";
constexpr const char* kBridgeHead = "UVWX";
constexpr const char* kArchShoulder = "klmn";
constexpr const char* kDwelling = "\x01\x02\x03\x04";
constexpr const char* kBushyRim = "\x05\x06\x07\x08";
constexpr const char* kBrokenFoot = "\x0B\x0C\x0E\x0F";

CanyonPalette add_materials(ExampleBuilder& builder) {
    const auto rock = [&builder](const char* name, std::uint32_t hex) {
        return builder.add_material({name, srgb(hex), 0, 0.92F});
    };
    return {
        rock("red rock", 0xE27E58),
        rock("orange rock", 0xF6AC74),
        rock("cream rock", 0xFDEACB),
        rock("dark rock", 0xBC6248),
        rock("sand", 0xF8DCB0),
        rock("dry grass", 0xEADB98),
        rock("green", 0x84B86A),
        builder.add_material({"water", srgb(0x58DCE0), 0, 0.25F}),
        rock("wood", 0xA47E5C)};
}

void add_terrain(ExampleBuilder& builder, const CanyonPalette& palette) {
    builder.add_empty(kAir, "air");
    builder.add_undrawn(kSolid, "rock");
    builder.add_piece(kValley, "valley", make_valley(palette));
    builder.add_piece(kTurf, "turf", make_turf(palette), 0.6);
    static constexpr std::array<const char*, kCliffKindCount> kKinds = {
        "foot", "cliff", "rim", "terrace"};
    // Long lines of cliff with few turns, higher than they are in the example.
    static constexpr std::array<double, kCliffKindCount> kWeights = {1, 4, 1, 1};
    static constexpr std::array<double, kCliffShapeCount> kShapeWeights = {2, 1.3, 1.3};
    static constexpr std::array<const char*, kCliffShapeCount> kShapes = {
        "_edge", "_corner", "_nook"};
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        for (std::size_t shape = 0; shape < kShapes.size(); ++shape) {
            const auto cliff_kind = static_cast<CliffKind>(kind);
            const auto cliff_shape = static_cast<CliffShape>(shape);
            builder.add_turned(
                cliff_letters(cliff_kind, cliff_shape),
                std::string(kKinds[kind]) + kShapes[shape],
                make_cliff(palette, cliff_kind, cliff_shape),
                kWeights[kind] * kShapeWeights[shape]
            );
        }
    }
    // A search goes from north-west to south-east: the corner at which it begins a mesa, or one
    // on a mesa, counts for more than those at which it ends them, and so they become large.
    constexpr int kNorthWest = 1;
    builder.set_weight(cliff_letter(CliffKind::kValleyFoot, CliffShape::kConvex, kNorthWest), 1.2);
    builder.set_weight(cliff_letter(CliffKind::kTerraceFoot, CliffShape::kConvex, kNorthWest), 18);
}

void add_things(ExampleBuilder& builder, const CanyonPalette& palette) {
    builder.add_turned(kDwelling, "cliff_dwelling", make_dwelling(palette), 0.7);
    builder.add_turned(kBushyRim, "rim_bushes", make_bushy_rim(palette), 1.2);
    builder.add_turned(kBrokenFoot, "foot_rockfall", make_rockfall(palette), 1.2);
    builder.add_piece('p', "pebbles", make_pebbles(palette));
    builder.add_piece('c', "saguaro", make_saguaro(palette));
    builder.add_piece('s', "sage", make_sage(palette));
    builder.add_piece('o', "boulders", make_boulders(palette), 1.5);
    builder.add_piece('t', "tufts", make_tufts(palette), 3);
    builder.add_piece('r', "slabs", make_slabs(palette), 2);
    builder.add_piece('j', "juniper", make_juniper(palette), 2);
    builder.add_turned(kHouse, "house", make_house(palette), 6);

    // As built these run to the south; the names of turns count from the east.
    const auto from_east = [](MeshBuilder mesh) {
        MeshBuilder turned;
        turned.turned(1, [&mesh](MeshBuilder& inner) { inner = std::move(mesh); });
        return turned;
    };
    builder.add_axial("-|", "stream", from_east(make_stream(palette)), 2);
    builder.add_turned(kStreamBend, "stream_bend", make_stream_bend(palette));
    // Where a ring of water would begin.
    builder.set_weight(kStreamBend[3], 0.15);
    builder.add_turned(kPool, "pool", from_east(make_pool(palette)), 0.15);
    builder.add_turned(kSpring, "spring", make_spring(palette), 4);

    builder.add_turned(kStair, "stair", make_stair(palette, CliffKind::kValleyFoot), 12);
    builder.add_turned(
        kTerraceStair, "terrace_stair", make_stair(palette, CliffKind::kTerraceFoot), 12
    );
    builder.add_turned(kStairHead, "stair_head", make_stair_head(palette));
    builder.add_axial("=\"", "bridge", make_bridge(palette), 3);
    builder.add_turned(kBridgeHead, "bridge_head", make_bridge_head(palette), 40);

    builder.add_piece('u', "hoodoo_foot", make_hoodoo_foot(palette));
    builder.add_piece('v', "hoodoo_shaft", make_hoodoo_middle(palette));
    builder.add_piece('w', "hoodoo_top", make_hoodoo_top(palette));
    builder.add_piece('f', "arch_foot", make_arch_foot(palette), 0.15);
    builder.add_piece('i', "arch_shaft", make_arch_shaft(palette));
    builder.add_turned(kArchShoulder, "arch_shoulder", make_arch_shoulder(palette));
    builder.add_axial("<^", "arch_span", make_arch_span(palette));
}

// What the characters of the map of things stand for. One that is a piece's own letter stands for
// that piece; S is a spring, / and \ are stairs from the valley and from a terrace, B = B and
// B " B bridges, H and K hoodoos, ( _ ) and < ! > arches.
std::map<char, Thing> things() {
    std::map<char, Thing> meaning;
    for (const char single : std::string("pcsotrj-|12345678abde")) {
        meaning[single] = {std::string(1, single)};
    }
    const auto in_cliff = [](const char* foot, const char* head) {
        Thing thing;
        for (std::size_t turn = 0; turn < 4; ++turn) {
            thing.turned_stack.push_back({foot[turn], head[turn]});
        }
        return thing;
    };
    meaning['S'] = in_cliff(kSpring, "****");
    meaning['/'] = in_cliff(kStair, kStairHead);
    meaning['\\'] = in_cliff(kTerraceStair, kStairHead);
    // Bridges hang two levels above the valley.
    meaning['B'] = in_cliff("****", "****");
    for (std::size_t turn = 0; turn < 4; ++turn) {
        meaning['B'].turned_stack[turn] += kBridgeHead[turn];
    }
    meaning['='] = {"**="};
    meaning['"'] = {"**\""};
    meaning['H'] = {"uw"};
    meaning['K'] = {"uvw"};
    // An arch from west to east, and one from north to south.
    meaning['('] = {std::string("fi") + kArchShoulder[0]};
    meaning['_'] = {"**<"};
    meaning[')'] = {std::string("fi") + kArchShoulder[2]};
    meaning['<'] = {std::string("fi") + kArchShoulder[3]};
    meaning['!'] = {"**^"};
    meaning['>'] = {std::string("fi") + kArchShoulder[1]};
    return meaning;
}

// Straight stretches of cliff are not all alike: at some places a variant of the same outline
// stands instead, spread evenly over the four turns.
void vary_cliffs(std::vector<std::vector<std::string>>& floors) {
    struct Variant {
        CliffKind kind;
        const char* letters;
        std::size_t every;
    };

    static constexpr std::array<Variant, 3> kVariants = {
        {{CliffKind::kMiddle, kDwelling, 5},
         {CliffKind::kRim, kBushyRim, 3},
         {CliffKind::kValleyFoot, kBrokenFoot, 4}}};
    for (const Variant& variant : kVariants) {
        for (std::size_t turn = 0; turn < 4; ++turn) {
            const char plain =
                cliff_letter(variant.kind, CliffShape::kEdge, static_cast<int>(turn));
            std::size_t count = 0;
            for (std::vector<std::string>& floor : floors) {
                for (std::string& row : floor) {
                    for (char& letter : row) {
                        if (letter == plain && ++count % variant.every == 0) {
                            letter = variant.letters[turn];
                        }
                    }
                }
            }
        }
    }
}

// clang-format off

// The heights of the corners of cells, in levels. Every pair of cliff shapes that can meet does
// meet somewhere, on every kind of cliff: that is what lets mesas take any outline.
std::vector<std::string_view> heights() {
    return {
        "0000000000000000000000000000000000",
        "0000022220000002222000002222222200",
        "0000022222000002222200022222222220",
        "0002222222002222222200022220000220",
        "0002222222222222222200022220000220",
        "0222444222222002222200022222220220",
        "0222444222222002220000000222220000",
        "0222222233332002220000000222200110",
        "0222222233332000000000000222201110",
        "0220000233332000000000000222200110",
        "0220000222222200000000000000000000",
        "0222222222222200000000000000000000",
        "0222222222200000000000000000000000",
        "0222222222200000000000000222200000",
        "0222233322200000000000000222200000",
        "0000233332200000000000000000000000",
        "0000233332200000000000000000000000",
        "0000223322200000000000000000000000",
        "0000222222200000000000000000000000",
        "0002200002200000000000000000000000",
        "0222200002200000000000000000000000",
        "0222200002200000000000000000000000",
        "0222200002200000000000222222222220",
        "0222222222200000000000222222222220",
        "0222222222200011111100222333332220",
        "0222222000000011111100222333332220",
        "0222222000000011111100223333332220",
        "0222222000000011111100223333332220",
        "0022222220000011111100223332222220",
        "0022244422200011111100223332222220",
        "0022244422200000000000222222222220",
        "0022222222200000000000222222222220",
        "0000000000000000000000000000000000",
    };
}

// What stands in the cells; see things().
std::vector<std::string_view> thing_map() {
    return {
        ".................................",
        "....................p.....t......",
        ".......................a.........",
        "............rt.....B==Bb.........",
        ".............S.........r.........",
        ".............|...................",
        ".............|....c..............",
        ".............|........5-Sde......",
        "....S........1--3.o...oc.abd.....",
        "....6o........o.|.........B......",
        "............j.p.|........s\"....c.",
        ".....r........s.|(_)......\"......",
        "......t..t......|.........B....s.",
        "...........4----2K...s...j....p..",
        "...........|..c...........S..c...",
        "...........|...<..c..K.p..|.(_)p.",
        "...........|.o.!..s.......6...o..",
        ".s.........|...>........4--------",
        "......B....|p....5--3...|p.c.....",
        "......\"s...|<H......|o.p|8..8....",
        "..e.S7\"s...|!...pc..1---2|.p|.K..",
        ".ab...\"....|>............S..S....",
        ".rt...B..r.|...p....H..derrj.....",
        "..r........|..././..5S....\\...r..",
        ".jt........|..ab........\\........",
        "...........|./d...r/s.t......\\...",
        "...........|o...........ttt...t..",
        "..........c|./...../...\\rt.......",
        "..r........|....j.........\\......",
        "...........|..././..p.j..\\.......",
        "...........|...........j.t...j.r.",
        "...........|.....................",
    };
}

// clang-format on

}  // namespace

discrete::Example make_canyon() {
    ExampleBuilder builder("canyon", kCanyonCell, kCanyonCell, kCanyonCell);
    const CanyonPalette palette = add_materials(builder);
    add_terrain(builder, palette);
    add_things(builder, palette);
    std::vector<std::vector<std::string>> floors =
        lay_out_terrain(heights(), thing_map(), things());
    vary_cliffs(floors);
    for (std::vector<std::string>& floor : floors) {
        builder.add_floor(std::move(floor));
    }
    using discrete::BoundaryKind;
    // Mesas end before the sides of a model, where their inside would show; streams may leave.
    const std::vector<std::string> low = {
        "air", "valley", "pebbles", "sage", "boulders", "saguaro"};
    const auto low_and = [&low](const char* stream) {
        discrete::SideBoundary side = {BoundaryKind::kPieces, low};
        side.pieces.emplace_back(stream);
        return side;
    };
    builder.set_boundary(
        {{low_and("stream_x"),
          low_and("stream_x"),
          {BoundaryKind::kPieces, {"air"}},
          {BoundaryKind::kExample, {}},
          low_and("stream_z"),
          low_and("stream_z")}}
    );
    builder.set_default_size({40, 8, 40});
    return std::move(builder).build();
}

}  // namespace modelsynth::examples
