#include "solver/examples/built_in.h"
#include "solver/examples/canyon_landmarks.h"
#include "solver/examples/canyon_props.h"
#include "solver/examples/canyon_terrain.h"
#include "solver/examples/example_builder.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

// Letters of the pieces that come in turns, east north west south.
constexpr const char* kStreamBend = "1234";  // from north to east, and so on round
constexpr const char* kPool = "5678";        // open to the ...
constexpr const char* kHouse = "ABCD";
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
        rock("red rock", 0xBE5A38),
        rock("orange rock", 0xD98650),
        rock("cream rock", 0xEBCB9C),
        rock("dark rock", 0x8C3B2B),
        rock("sand", 0xE3B681),
        rock("dry grass", 0xB5A55C),
        rock("green", 0x6B8A58),
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
    static constexpr std::array<const char*, kCliffShapeCount> kShapes = {
        "_edge", "_corner", "_nook"};
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        for (std::size_t shape = 0; shape < kShapes.size(); ++shape) {
            const auto cliff_kind = static_cast<CliffKind>(kind);
            const auto cliff_shape = static_cast<CliffShape>(shape);
            builder.add_turned(
                cliff_letters(cliff_kind, cliff_shape),
                std::string(kKinds[kind]) + kShapes[shape],
                make_cliff(palette, cliff_kind, cliff_shape)
            );
        }
    }
}

void add_things(ExampleBuilder& builder, const CanyonPalette& palette) {
    builder.add_piece('p', "pebbles", make_pebbles(palette));
    builder.add_piece('c', "saguaro", make_saguaro(palette));
    builder.add_piece('s', "sage", make_sage(palette));
    builder.add_piece('o', "boulders", make_boulders(palette));
    builder.add_piece('t', "tufts", make_tufts(palette));
    builder.add_piece('j', "juniper", make_juniper(palette));
    builder.add_turned(kHouse, "house", make_house(palette));

    // As built these run to the south; the names of turns count from the east.
    const auto from_east = [](MeshBuilder mesh) {
        MeshBuilder turned;
        turned.turned(1, [&mesh](MeshBuilder& inner) { inner = std::move(mesh); });
        return turned;
    };
    builder.add_axial("-|", "stream", from_east(make_stream(palette)));
    builder.add_turned(kStreamBend, "stream_bend", make_stream_bend(palette));
    builder.add_turned(kPool, "pool", from_east(make_pool(palette)));
    builder.add_turned(kSpring, "spring", make_spring(palette));

    builder.add_turned(kStair, "stair", make_stair(palette, CliffKind::kValleyFoot));
    builder.add_turned(
        kTerraceStair, "terrace_stair", make_stair(palette, CliffKind::kTerraceFoot)
    );
    builder.add_turned(kStairHead, "stair_head", make_stair_head(palette));
    builder.add_axial("=\"", "bridge", make_bridge(palette));
    builder.add_turned(kBridgeHead, "bridge_head", make_bridge_head(palette));

    builder.add_piece('u', "hoodoo_foot", make_hoodoo_foot(palette));
    builder.add_piece('v', "hoodoo_shaft", make_hoodoo_middle(palette));
    builder.add_piece('w', "hoodoo_top", make_hoodoo_top(palette));
    builder.add_piece('f', "arch_foot", make_arch_foot(palette));
    builder.add_piece('i', "arch_shaft", make_arch_shaft(palette));
    builder.add_turned(kArchShoulder, "arch_shoulder", make_arch_shoulder(palette));
    builder.add_axial("<^", "arch_span", make_arch_span(palette));
}

// What the characters of the map of things stand for.
std::map<char, Thing> things() {
    std::map<char, Thing> meaning;
    for (const char single : std::string("pcsotj-|12345678ABCD")) {
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

// The heights of the corners of cells, in levels. Every pair of cliff shapes that can meet does
// meet somewhere, on every kind of cliff: that is what lets mesas take any outline.
std::vector<std::string_view> heights() {
    return {
        "0000000000000000000000000000000000", "0202000000000000000000022220222220",
        "0222222000000000022200022222212120", "0211112000003333022200022223211120",
        "0211222000003333022200022422222220", "0212222010000000022200022223211200",
        "0212112000200002000002224233221220", "0222222202200002030000222223322220",
        "0222222222200000000002222222222220", "0220000242220000000002442222222220",
        "0000000242020000000002222000022220", "0102222222000000000002000000022220",
        "0102222222220000000000000000023320", "0100211232200000000000000222222220",
        "0110222232200000000000000222211220", "0000200233200000000000000000222220",
        "0000220223200000000000011000020000", "0000022222200000000000010000000000",
        "0000220222200000000000110000000000", "0002200002200000000000010000000000",
        "0002200002200000000000000033000000", "0002200002200000000000000000000000",
        "0002200002200000000000222222222200", "0000000000000000000000222222222220",
        "0000444444400011111100223333332220", "0000444455400011111100223333332220",
        "0000044554400011111100223333332220", "0001004444000011111100223333332220",
        "0000000424400011111100223333332220", "0000004444000011111100223333332220",
        "0000000000000000000000222222222220", "0000000000000000000000222222222200",
        "0000000000000000000000000000000000",
    };
}

std::vector<std::string_view> thing_map() {
    return {
        ".............8...................",  ".........o...|.......s...........",
        ".......K.H...S...................",  "......S7H....tt...tB==Bt.........",
        "..........s..S....t..............",  "...........o.|...................",
        "............p|.................t.",  ".............|...................",
        "....S.......c1--3p...............",  "....6.......p...|.........B...t..",
        "................|.........\"......", "...A............|.<.......\"s.....",
        ".........j......|.!.......B......",  "...........4----2.!..............",
        "...........|......!(__)..........",  "...........|......>.......s......",
        "...........|.............p.......",  ".s......j..|scp....K....4--------",
        ".p.........|(___)5--3...|........",  "...j.o.....|..os....|...|....8p..",
        "....B===B..|..c.pc.s1---2....|...",  "......p....|...o....p........S...",
        ".p...o.....|p.c.c......jt....j...",  ".c.........|..../...K.....\\......",
        "...........|...t....5S...j....B..",  "...........|</C.D../...\\....A....",
        "...........|!.........j..B.t.\\...", "...........|!/j...j/..C\\...tt.t..",
        "...........|>....t..5S........t..",  ".co....S...|..././.......\\.\\.....",
        "...s..c6...|.....so.......t...D..",  "...........|.....................",
    };
}

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
