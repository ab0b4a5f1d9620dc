#pragma once

#include "solver/examples/castle_shapes.h"

// Timbered cottages in rows of two cells and more, and fields.
namespace modelsynth::examples::castle {

// The east end of a row along x, and what may lie between its ends. The roof reaches up into the
// air above the cell.
[[nodiscard]] MeshBuilder make_cottage_end(const Palette& palette);
[[nodiscard]] MeshBuilder make_cottage_middle(const Palette& palette);

// Fields two cells wide, in a fence: a corner towards the east and north, a side towards the east.
[[nodiscard]] MeshBuilder make_field_corner(const Palette& palette);
[[nodiscard]] MeshBuilder make_field_side(const Palette& palette);

}  // namespace modelsynth::examples::castle
