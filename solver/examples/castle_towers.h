#pragma once

#include "solver/examples/castle_shapes.h"

// Buildings: turrets of one cell, and bodies of two cells and more (towers, keeps, halls), made of
// corners and sides that look outwards. Corners are built looking east and north, sides east.
namespace modelsynth::examples::castle {

// --- turrets
[[nodiscard]] MeshBuilder make_turret_foot(const Palette& palette);
[[nodiscard]] MeshBuilder make_turret_storey(const Palette& palette, bool windows);
[[nodiscard]] MeshBuilder make_turret_battlement(const Palette& palette);
[[nodiscard]] MeshBuilder make_turret_roof(const Palette& palette, bool flag);

// --- bodies
[[nodiscard]] MeshBuilder make_foot_corner(const Palette& palette);
[[nodiscard]] MeshBuilder make_foot_side(const Palette& palette, bool door);
[[nodiscard]] MeshBuilder make_storey_corner(const Palette& palette);
[[nodiscard]] MeshBuilder make_storey_side(const Palette& palette);
// Nothing of the inside shows; a sheet of floor keeps the piece from being nothing at all.
[[nodiscard]] MeshBuilder make_inside(const Palette& palette);
[[nodiscard]] MeshBuilder make_battlement_corner(const Palette& palette);

}  // namespace modelsynth::examples::castle
