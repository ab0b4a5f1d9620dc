// Castle: sandstone walls and blue roofs at noon. Curtain walls turn, fork and cross between
// turrets, towers and keeps, close courts with halls in them, and let paths through their gates.

#include "solver/examples/built_in.h"
#include "solver/examples/castle_floors.h"
#include "solver/examples/castle_ground.h"
#include "solver/examples/castle_roofs.h"
#include "solver/examples/castle_towers.h"
#include "solver/examples/castle_walls.h"
#include "solver/examples/example_builder.h"

namespace modelsynth::examples {

namespace {

castle::Palette add_palette(ExampleBuilder& builder) {
    castle::Palette palette;
    palette.stone = builder.add_material({"sandstone", srgb(0xE2C48D), 0, 0.9F});
    palette.trim = builder.add_material({"deep sandstone", srgb(0xBC9460), 0, 0.9F});
    palette.slate = builder.add_material({"blue slate", srgb(0x3E6C9C), 0, 0.65F});
    palette.grass = builder.add_material({"grass", srgb(0x9DB05A), 0, 0.95F});
    palette.paving = builder.add_material({"paving", srgb(0xD6C7A6), 0, 0.9F});
    palette.dark = builder.add_material({"dark", srgb(0x2B2730), 0, 0.8F});
    palette.wood = builder.add_material({"wood", srgb(0x8A5E38), 0, 0.8F});
    palette.flag = builder.add_material({"flag red", srgb(0xC23A30), 0, 0.8F});
    palette.leaf = builder.add_material({"leaf", srgb(0x5E8F3E), 0, 0.9F});
    palette.gold = builder.add_material({"gold", srgb(0xE8B840), 1, 0.45F});
    return palette;
}

void add_ground(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_empty(' ', "air");
    builder.add_piece('.', "grass", make_grass(palette), 0.25);
    builder.add_piece(',', "tufts", make_tufts(palette), 0.6);
    builder.add_piece('*', "boulders", make_boulders(palette));
    builder.add_axial("-|", "path", make_path(palette), 0.6);
    builder.add_piece('o', "place", make_place(palette), 0.2);
    builder.add_piece('t', "tree", make_tree_foot(palette));
    builder.add_piece('T', "tree_crown", make_tree_crown(palette));
    builder.add_piece('y', "cypress", make_cypress_foot(palette));
    builder.add_piece('Y', "cypress_crown", make_cypress_crown(palette));
    builder.add_piece('w', "well", make_well(palette));
}

void add_walls(ExampleBuilder& builder, const castle::Palette& palette) {
    constexpr castle::Arms kStraight = {true, false, true, false};
    constexpr castle::Arms kCorner = {true, true, false, false};
    constexpr castle::Arms kFork = {true, true, false, true};
    constexpr castle::Arms kCross = {true, true, true, true};
    builder.add_axial("=!", "wall_foot", make_wall_foot(palette, kStraight), 2);
    builder.add_axial("~:", "wall_top", make_wall_top(palette, kStraight));
    builder.add_turned("1234", "wall_corner_foot", make_wall_foot(palette, kCorner));
    builder.add_turned("abcd", "wall_corner_top", make_wall_top(palette, kCorner));
    builder.add_turned("5678", "wall_fork_foot", make_wall_foot(palette, kFork));
    builder.add_turned("efgh", "wall_fork_top", make_wall_top(palette, kFork));
    builder.add_piece('+', "wall_cross_foot", make_wall_foot(palette, kCross));
    builder.add_piece('%', "wall_cross_top", make_wall_top(palette, kCross));
    builder.add_axial("&;", "gate_foot", make_gate_foot(palette), 3);
    builder.add_axial("'N", "gate_top", make_gate_top(palette));
}

void add_towers(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_piece('i', "turret_foot", make_turret_foot(palette), 0.6);
    builder.add_piece('l', "turret_storey", make_turret_storey(palette, false), 0.6);
    builder.add_piece('I', "turret_windows", make_turret_storey(palette, true));
    builder.add_piece('M', "turret_battlement", make_turret_battlement(palette));
    builder.add_piece('^', "turret_roof", make_turret_roof(palette, false));
    builder.add_piece('u', "turret_roof_flag", make_turret_roof(palette, true));

    builder.add_turned("ABCD", "foot_corner", make_foot_corner(palette));
    builder.add_turned("EFGH", "foot_side", make_foot_side(palette, false), 0.6);
    builder.add_turned("JKLO", "door", make_foot_side(palette, true));
    builder.add_piece('#', "inside_foot", make_inside(palette), 0.6);
    builder.add_turned("QRSV", "storey_corner", make_storey_corner(palette), 0.8);
    builder.add_turned("jkpq", "storey_side", make_storey_side(palette));
    builder.add_piece('@', "inside", make_inside(palette));
    builder.add_turned("rsvx", "battlement_corner", make_battlement_corner(palette), 1.6);
    builder.add_turned("{}<>", "battlement_side", make_battlement_side(palette));
    builder.add_piece('_', "deck", make_deck(palette, false));
    builder.add_piece('P', "deck_flag", make_deck(palette, true));
}

void add_roofs(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_turned("WXZz", "roof_corner", make_roof_corner(palette), 0.8);
    builder.add_turned("/()U", "roof_side", make_roof_side(palette));
    builder.add_piece('?', "roof_chimney", make_roof_chimney(palette), 0.6);
    builder.add_turned("[]$`", "roof_valley", make_roof_valley(palette));
    MeshBuilder flagged = make_spire(palette);
    add_spire_flag(flagged, palette);
    builder.add_piece('m', "spire_e", std::move(flagged), 3);
    const char* const names[] = {"spire_n", "spire_w", "spire_s"};
    for (int turns = 1; turns < 4; ++turns) {
        builder.add_piece(
            "n09"[turns - 1],
            names[turns - 1],
            std::move(MeshBuilder().turned(
                turns, [&](MeshBuilder& quarter) { quarter = make_spire(palette); }
            )),
            3
        );
    }
}

}  // namespace

discrete::Example make_castle() {
    ExampleBuilder builder("castle", 2, 2, 2);
    const castle::Palette palette = add_palette(builder);
    add_ground(builder, palette);
    add_walls(builder, palette);
    add_towers(builder, palette);
    add_roofs(builder, palette);
    castle::add_floors(builder);
    // Nothing is cut at the sides: only open ground, and paths that lead out.
    const auto side = [](const char* path) {
        return discrete::SideBoundary{
            discrete::BoundaryKind::kPieces,
            {"air",
             "grass",
             "tufts",
             "boulders",
             "tree",
             "tree_crown",
             "cypress",
             "cypress_crown",
             path}};
    };
    builder.set_boundary(
        {{side("path_x"),
          side("path_x"),
          {discrete::BoundaryKind::kPieces, {"air"}},
          {discrete::BoundaryKind::kExample, {}},
          side("path_z"),
          side("path_z")}}
    );
    builder.set_default_size({40, 10, 40});
    return std::move(builder).build();
}

}  // namespace modelsynth::examples
