#pragma once

#include "solver/examples/castle_shapes.h"

// The meadow: grass, paths, trees.
namespace modelsynth::examples::castle {

[[nodiscard]] MeshBuilder make_grass(const Palette& palette);
// Tufts, flowers and a stone.
[[nodiscard]] MeshBuilder make_wild(const Palette& palette);
// Beside a wall that stands in the west.
[[nodiscard]] MeshBuilder make_meadow_edge(const Palette& palette);
// A path along x, and one from the east to the north.
[[nodiscard]] MeshBuilder make_path(const Palette& palette);
[[nodiscard]] MeshBuilder make_path_bend(const Palette& palette);
// A small paved place, which paths may reach from any side.
[[nodiscard]] MeshBuilder make_place(const Palette& palette);
// Trees reach up into the air above their cell.
[[nodiscard]] MeshBuilder make_tree(const Palette& palette);
[[nodiscard]] MeshBuilder make_cypress(const Palette& palette);

}  // namespace modelsynth::examples::castle
