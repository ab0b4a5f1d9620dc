#pragma once

#include "solver/examples/castle_shapes.h"

// Roofs over bodies, in slopes one cell wide. Corners and valleys are built towards the north-east,
// sides towards the east.
namespace modelsynth::examples::castle {

[[nodiscard]] MeshBuilder make_roof_corner(const Palette& palette);
[[nodiscard]] MeshBuilder make_roof_side(const Palette& palette);
// A side towards the south, with a chimney.
[[nodiscard]] MeshBuilder make_roof_chimney(const Palette& palette);
[[nodiscard]] MeshBuilder make_roof_valley(const Palette& palette);

// A quarter of the steep roof of a tower of two by two; one of the four carries the flag.
[[nodiscard]] MeshBuilder make_spire(const Palette& palette);
void add_spire_flag(MeshBuilder& mesh, const Palette& palette);

}  // namespace modelsynth::examples::castle
