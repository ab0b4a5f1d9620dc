#pragma once

#include "solver/examples/canyon_palette.h"

// Variants of straight stretches of cliff, facing east: same outline, more to see.
namespace modelsynth::examples {

// A middle with an alcove of mud-brick rooms.
[[nodiscard]] MeshBuilder make_dwelling(const CanyonPalette& palette);
// A rim with bushes on top.
[[nodiscard]] MeshBuilder make_bushy_rim(const CanyonPalette& palette);
// A foot with fallen blocks on its talus.
[[nodiscard]] MeshBuilder make_rockfall(const CanyonPalette& palette);

}  // namespace modelsynth::examples
