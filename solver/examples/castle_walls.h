#pragma once

#include "solver/examples/castle_shapes.h"

#include <array>

// Curtain walls, two cells high, and the gates in them.
namespace modelsynth::examples::castle {

// To which sides a wall leads on: east, north, west, south.
using Arms = std::array<bool, 4>;

[[nodiscard]] MeshBuilder make_wall_foot(const Palette& palette, const Arms& arms);
[[nodiscard]] MeshBuilder make_wall_top(const Palette& palette, const Arms& arms);

// A gate in a wall along x, its road along z: piers with the road, the arch above.
[[nodiscard]] MeshBuilder make_gate_foot(const Palette& palette);
[[nodiscard]] MeshBuilder make_gate_top(const Palette& palette);

}  // namespace modelsynth::examples::castle
