#pragma once

#include "solver/examples/canyon_palette.h"

namespace modelsynth::examples {

// --- free-standing rock, a piece per level

[[nodiscard]] MeshBuilder make_hoodoo_foot(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_hoodoo_middle(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_hoodoo_top(const CanyonPalette& palette);

// --- a natural arch: two legs, each a foot, any number of shafts and a shoulder that bends to the
// east, and a span along x between the shoulders

[[nodiscard]] MeshBuilder make_arch_foot(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_arch_shaft(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_arch_shoulder(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_arch_span(const CanyonPalette& palette);

}  // namespace modelsynth::examples
