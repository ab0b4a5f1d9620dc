#pragma once

#include "solver/examples/kit/mesh_builder.h"

namespace modelsynth::examples {

// The palette: cream, ochre, mint and brick under terracotta and slate, on a sunny morning.
struct CityMaterials {
    MaterialId asphalt = 0;
    MaterialId paving = 0;
    MaterialId stone = 0;
    MaterialId plaster = 0;
    MaterialId ochre = 0;
    MaterialId mint = 0;
    MaterialId brick = 0;
    MaterialId wood = 0;
    MaterialId tile = 0;
    MaterialId slate = 0;
    MaterialId glass = 0;
    MaterialId glow = 0;
    MaterialId leaf = 0;
    MaterialId accent = 0;
    MaterialId iron = 0;
};

// A cell is 4 x 3 x 4 m; pieces reach half of its width from their middle.
inline constexpr float kCityHalf = 2;
inline constexpr float kCityStorey = 3;
// Pavements and squares lie this high, a kerb above the road.
inline constexpr float kPavingTop = 0.15F;
inline constexpr float kRoadTop = 0.03F;

}  // namespace modelsynth::examples
