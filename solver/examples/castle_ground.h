#pragma once

#include "solver/examples/castle_shapes.h"

// Everything that lies open: grass, paths, trees, a well.
namespace modelsynth::examples::castle {

[[nodiscard]] MeshBuilder make_grass(const Palette& palette);
[[nodiscard]] MeshBuilder make_tufts(const Palette& palette);
[[nodiscard]] MeshBuilder make_boulders(const Palette& palette);
// A path along x.
[[nodiscard]] MeshBuilder make_path(const Palette& palette);
// A small paved place, which paths may reach from any side.
[[nodiscard]] MeshBuilder make_place(const Palette& palette);
[[nodiscard]] MeshBuilder make_tree_foot(const Palette& palette);
[[nodiscard]] MeshBuilder make_tree_crown(const Palette& palette);
[[nodiscard]] MeshBuilder make_cypress_foot(const Palette& palette);
[[nodiscard]] MeshBuilder make_cypress_crown(const Palette& palette);
[[nodiscard]] MeshBuilder make_well(const Palette& palette);

}  // namespace modelsynth::examples::castle
