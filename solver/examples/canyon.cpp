#include "solver/examples/built_in.h"
#include "solver/examples/canyon_landmarks.h"
#include "solver/examples/canyon_props.h"
#include "solver/examples/canyon_spires.h"
#include "solver/examples/canyon_terrain.h"
#include "solver/examples/example_builder.h"

#include <array>
#include <utility>

// A red canyon at late noon: mesas and terraces of layered sandstone about turquoise streams, with
// natural arches, hoodoos, stairs cut into the rock, rope bridges and houses of mud brick on top.
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

CanyonPalette add_materials(ExampleBuilder& builder) {
    const auto rock = [&builder](const char* name, std::uint32_t hex) {
        return builder.add_material({name, srgb(hex), 0, 0.92F});
    };
    return {
        rock("red rock", 0xC2573A),
        rock("orange rock", 0xDE8A50),
        rock("cream rock", 0xF0D0A0),
        rock("dark rock", 0x8C3B2B),
        rock("sand", 0xE6B98A),
        rock("dry grass", 0xC4A75A),
        rock("green", 0x628C5C),
        builder.add_material({"water", srgb(0x2FA7A9), 0, 0.25F}),
        rock("wood", 0x6B4A34)};
}

void add_terrain(ExampleBuilder& builder, const CanyonPalette& palette) {
    builder.add_empty(kAir, "air");
    builder.add_undrawn(kSolid, "rock");
    builder.add_piece(kValley, "valley", make_valley(palette));
    builder.add_piece(kTurf, "turf", make_turf(palette));
    static constexpr std::array<const char*, kCliffKindCount> kKinds = {
        "foot", "cliff", "rim", "terrace"};
    // More terraces than the example has: a mesa on a mesa is what tells a canyon from a plain.
    static constexpr std::array<double, kCliffKindCount> kWeights = {1.2, 1, 1, 2.5};
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
                kWeights[kind]
            );
        }
    }
}

void add_things(ExampleBuilder& builder, const CanyonPalette& palette) {
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
    builder.add_axial("-|", "stream", from_east(make_stream(palette)));
    builder.add_turned(kStreamBend, "stream_bend", make_stream_bend(palette));
    builder.add_turned(kPool, "pool", from_east(make_pool(palette)));
    builder.add_turned(kSpring, "spring", make_spring(palette), 3);

    builder.add_turned(kStair, "stair", make_stair(palette, CliffKind::kValleyFoot), 5);
    builder.add_turned(
        kTerraceStair, "terrace_stair", make_stair(palette, CliffKind::kTerraceFoot), 8
    );
    builder.add_turned(kStairHead, "stair_head", make_stair_head(palette));
    builder.add_axial("=\"", "bridge", make_bridge(palette), 3);
    builder.add_turned(kBridgeHead, "bridge_head", make_bridge_head(palette), 16);

    builder.add_piece('u', "hoodoo_foot", make_hoodoo_foot(palette), 2);
    builder.add_piece('v', "hoodoo_shaft", make_hoodoo_middle(palette));
    builder.add_piece('w', "hoodoo_top", make_hoodoo_top(palette));
    builder.add_piece('f', "arch_foot", make_arch_foot(palette), 1.5);
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

// clang-format off

// The heights of the corners of cells, in levels. Every pair of cliff shapes that can meet does
// meet somewhere, on every kind of cliff: that is what lets mesas take any outline.
std::vector<std::string_view> heights() {
    return {
        "0000000000000000000000000000000000",
        "0000022220004002222000002222222200",
        "0000021122000000022200022122221220",
        "0002222112003333002200022221111200",
        "0002421122203333022200022121111220",
        "0202422220200000022200022222222220",
        "0222423322222003020000000212020000",
        "0202222333332003020000000222000110",
        "0222222223232000000000000222201100",
        "0220000233232000000000000222200110",
        "0220000222222200000000000000000000",
        "0222222222002200000000000000010000",
        "0212222222200000000000000000000000",
        "0211222222200000000000000222200000",
        "0222233242200000000000000222200000",
        "0000232222000000000000000000000000",
        "0000222322200000000000000000000000",
        "0000242333200000000000000000000000",
        "0000222222200000000000000000000000",
        "0002200002200000000000000000000000",
        "0222200002200000000000000000000000",
        "0222200002200000000000000000000000",
        "0222200002200000000000222222222220",
        "0222222222200000000000222222222220",
        "0222212000000011111100223333332220",
        "0222212000200011111100223333332220",
        "0222222010000011111100223333332220",
        "0222200000000011111100223333332220",
        "0022004040000011111100223333332220",
        "0022044440400011111100223333332220",
        "0000042244400000000000222222222220",
        "0044444440400000000000222222222220",
        "0000000000000000000000000000000000",
    };
}

// What stands in the cells; see things().
std::vector<std::string_view> thing_map() {
    return {
        ".................................",
        "....................p.....t......",
        ".......................a.........",
        "............rt.....B==Bb.....t...",
        ".............S.........r....\\....",
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
        "........t..|...<..c..K.p..|.(_)p.",
        "...........|.o.!..s.......6...o..",
        ".s.........|...>........4--------",
        "......B....|p....5--3...|p.c.....",
        "......\"s...|<H......|o.p|8..8....",
        "..e.S7\"s...|!...pc..1---2|.p|.K..",
        ".ab...\"....|>............S..S....",
        ".rt...B..r.|...p....H..derrj.....",
        "..r........|..././..5S....\\...r..",
        ".jt.....s..|..ab........r........",
        "...........|./d...r/s.t\\t....\\...",
        "...........|o...........ttt...t..",
        "..........c|./...../...\\rt..j\\...",
        "..r........|....j................",
        "...........|..././..p.j..\\.\\.....",
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
    for (std::vector<std::string>& floor : lay_out_terrain(heights(), thing_map(), things())) {
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
