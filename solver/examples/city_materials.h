#pragma once

#include "solver/examples/kit/mesh_builder.h"

namespace modelsynth::examples {

// The palette: wet slate-blue dusk, warm brick and lit windows against it.
struct CityMaterials {
    MaterialId asphalt = 0;  // also iron, when tinted dark
    MaterialId paving = 0;
    MaterialId stone = 0;
    MaterialId brick = 0;
    MaterialId slate = 0;
    MaterialId glass = 0;
    MaterialId glow = 0;
    MaterialId leaf = 0;
    MaterialId accent = 0;
};

// A cell is 4 x 3 x 4 m; pieces reach half of its width from their middle.
inline constexpr float kCityHalf = 2;
inline constexpr float kCityStorey = 3;
// Pavements and plazas lie this high, a kerb above the road.
inline constexpr float kPavingTop = 0.15F;

}  // namespace modelsynth::examples
