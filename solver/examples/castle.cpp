// Castle: sandstone walls and blue roofs at noon. Curtain walls part courts from the meadow, and
// close wherever they go, because nothing else may lie between the two grounds; halls and keeps
// stand in the courts, cottages with red roofs on the meadow, and paths lead to the gates.

#include "solver/examples/built_in.h"
#include "solver/examples/castle_court.h"
#include "solver/examples/castle_floors.h"
#include "solver/examples/castle_ground.h"
#include "solver/examples/castle_plan.h"
#include "solver/examples/castle_roofs.h"
#include "solver/examples/castle_towers.h"
#include "solver/examples/castle_village.h"
#include "solver/examples/castle_walls.h"
#include "solver/examples/example_builder.h"

#include <array>
#include <string>
#include <utility>

namespace modelsynth::examples {

namespace {

using castle::letter_of;
using castle::letters_of;

castle::Palette add_palette(ExampleBuilder& builder) {
    const auto add = [&builder](const char* name, std::uint32_t hex, float metallic, float rough) {
        return builder.add_material({name, srgb(hex), metallic, rough});
    };
    castle::Palette palette;
    palette.stone = add("sandstone", 0xF2E4C2, 0, 0.9F);
    palette.trim = add("deep sandstone", 0xE2BC88, 0, 0.9F);
    palette.slate = add("blue slate", 0x5FA4EE, 0, 0.65F);
    palette.grass = add("grass", 0xBCDC74, 0, 0.95F);
    palette.paving = add("paving", 0xF0E8D4, 0, 0.9F);
    palette.dark = add("dark", 0x54495A, 0, 0.8F);
    palette.wood = add("wood", 0xBA8656, 0, 0.8F);
    palette.flag = add("flag red", 0xF04A36, 0, 0.8F);
    palette.leaf = add("leaf", 0x86C652, 0, 0.9F);
    palette.gold = add("gold", 0xFFD65A, 0.3F, 0.5F);
    palette.earth = add("trodden earth", 0xF0DAB0, 0, 0.95F);
    palette.plaster = add("plaster", 0xFBF6EA, 0, 0.9F);
    palette.tile = add("red tile", 0xF28A58, 0, 0.8F);
    palette.wheat = add("wheat", 0xFADA6A, 0, 0.95F);
    return palette;
}

void add_meadow(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_empty(letter_of(castle::kAir), "air");
    builder.add_undrawn(letter_of(castle::kUpper), "upper");
    builder.add_piece('.', "grass", make_grass(palette), 0.3);
    builder.add_piece(',', "wild", make_wild(palette));
    builder.add_piece('t', "tree", make_tree(palette), 1.5);
    builder.add_piece('y', "cypress", make_cypress(palette), 1.5);
    builder.add_piece('o', "place", make_place(palette), 0.2);
    builder.add_axial(letters_of(castle::kPathX, 2), "path", make_path(palette), 0.7);
    builder.add_turned(letters_of(castle::kPathBend), "path_bend", make_path_bend(palette), 2);
    builder.add_axial(
        letters_of(castle::kCottageMiddleX, 2), "cottage_middle", make_cottage_middle(palette)
    );
    builder.add_turned(letters_of(castle::kCottage), "cottage", make_cottage_end(palette), 3);
    builder.add_turned(
        letters_of(castle::kFieldCorner), "field_corner", make_field_corner(palette)
    );
    builder.add_turned(letters_of(castle::kFieldSide), "field_side", make_field_side(palette), 3);
    builder.add_turned(letters_of(castle::kMeadowEdge), "meadow_edge", make_meadow_edge(palette));
}

void add_court(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_turned(letters_of(castle::kCourt), "court", make_court(palette), 0.3);
    builder.add_piece('b', "stores", make_stores(palette), 2);
    builder.add_piece('w', "well", make_well(palette), 2);
    builder.add_turned(letters_of(castle::kCourtEdge), "court_edge", make_court_edge(palette));
    builder.add_turned(letters_of(castle::kShed), "shed", make_shed(palette), 3);
}

void add_walls(ExampleBuilder& builder, const castle::Palette& palette) {
    using castle::CurtainShape;
    const auto curtain = [&](CurtainShape shape) { return make_curtain(palette, shape); };
    builder.add_turned(letters_of(castle::kCurtain), "wall", curtain(CurtainShape::kStraight), 8);
    builder.add_turned(
        letters_of(castle::kCurtainConvex), "wall_corner", curtain(CurtainShape::kConvex), 0.6
    );
    builder.add_turned(
        letters_of(castle::kCurtainConcave), "wall_nook", curtain(CurtainShape::kConcave), 0.6
    );
    builder.add_turned(letters_of(castle::kGate), "gate", make_gate(palette), 6);
    builder.add_axial("=\"", "inner_wall", make_inner_wall(palette));
    builder.add_axial("nu", "inner_gate", make_inner_gate(palette), 4);
}

void add_towers(ExampleBuilder& builder, const castle::Palette& palette) {
    const auto foot = [&] { return make_turret_foot(palette); };
    builder.add_turned(letters_of(castle::kTurret), "turret", foot(), 1.6);
    builder.add_turned(letters_of(castle::kTurretConvex), "turret_corner", foot(), 0.6);
    builder.add_turned(letters_of(castle::kTurretConcave), "turret_nook", foot(), 0.6);
    builder.add_piece('l', "turret_storey", make_turret_storey(palette, false));
    builder.add_piece('I', "turret_windows", make_turret_storey(palette, true));
    builder.add_piece('M', "turret_battlement", make_turret_battlement(palette));
    builder.add_piece('^', "turret_roof", make_turret_roof(palette, false));
    builder.add_piece('v', "turret_roof_flag", make_turret_roof(palette, true));
}

void add_halls(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_turned(letters_of(castle::kFootCorner), "foot_corner", make_foot_corner(palette));
    builder.add_turned(
        letters_of(castle::kFootSide), "foot_side", make_foot_side(palette, false), 3
    );
    builder.add_turned(letters_of(castle::kDoor), "door", make_foot_side(palette, true));
    builder.add_piece(letter_of(castle::kInside), "inside", make_inside(palette), 0.5);
    builder.add_turned(
        letters_of(castle::kStoreyCorner), "storey_corner", make_storey_corner(palette), 2
    );
    builder.add_turned(letters_of(castle::kStoreySide), "storey_side", make_storey_side(palette));
    builder.add_turned(
        letters_of(castle::kRoofCorner), "roof_corner", make_roof_corner(palette), 1.5
    );
    builder.add_turned(letters_of(castle::kRoofSide), "roof_side", make_roof_side(palette));
    builder.add_piece(letter_of(castle::kChimney), "roof_chimney", make_roof_chimney(palette));
    builder.add_turned(letters_of(castle::kRoofValley), "roof_valley", make_roof_valley(palette));
}

void add_keeps(ExampleBuilder& builder, const castle::Palette& palette) {
    builder.add_turned(
        letters_of(castle::kKeepShaft), "keep_shaft", make_storey_corner(palette), 0.8
    );
    builder.add_turned(
        letters_of(castle::kKeepBattlement), "keep_battlement", make_battlement_corner(palette)
    );
    // One quarter of the spire carries the flag.
    static constexpr std::array<const char*, 4> kNames = {"e", "n", "w", "s"};
    for (int turns = 0; turns < 4; ++turns) {
        MeshBuilder quarter;
        quarter.turned(turns, [&](MeshBuilder& spire) { spire = make_spire(palette); });
        if (turns == 0) {
            add_spire_flag(quarter, palette);
        }
        builder.add_piece(
            letter_of(castle::kKeepSpire, turns),
            std::string("keep_spire_") + kNames[static_cast<std::size_t>(turns)],
            std::move(quarter)
        );
    }
}

// A search goes from north-west to south-east. What it begins castles, halls and fields with counts
// for more than what it ends them with, so that they come often and become large. A castle begins
// with the meadow on the west of its wall.
void encourage_beginnings(ExampleBuilder& builder) {
    constexpr int kNorthWest = 1;
    constexpr int kWest = 2;
    builder.set_weight(letter_of(castle::kMeadowEdge, kWest), 4);
    builder.set_weight(letter_of(castle::kFootCorner, kNorthWest), 80);
    builder.set_weight(letter_of(castle::kFieldCorner, kNorthWest), 3);
}

}  // namespace

discrete::Example make_castle() {
    ExampleBuilder builder("castle", 2, 2, 2);
    const castle::Palette palette = add_palette(builder);
    add_meadow(builder, palette);
    add_court(builder, palette);
    add_walls(builder, palette);
    add_towers(builder, palette);
    add_halls(builder, palette);
    add_keeps(builder, palette);
    castle::add_floors(builder);
    encourage_beginnings(builder);
    // Nothing is cut at the sides: only open ground, and paths that lead out.
    const auto side = [](const char* path) {
        return discrete::SideBoundary{
            discrete::BoundaryKind::kPieces,
            {"air", "grass", "wild", "tree", "cypress", "upper", path}};
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
