#pragma once

#include "solver/examples/castle_shapes.h"

// What lies and stands inside the walls.
namespace modelsynth::examples::castle {

[[nodiscard]] MeshBuilder make_court(const Palette& palette);
// Beside a wall that stands in the west: with a gutter, or a shed that leans on the wall.
[[nodiscard]] MeshBuilder make_court_edge(const Palette& palette);
[[nodiscard]] MeshBuilder make_shed(const Palette& palette);
[[nodiscard]] MeshBuilder make_stores(const Palette& palette);
[[nodiscard]] MeshBuilder make_well(const Palette& palette);

}  // namespace modelsynth::examples::castle
