#pragma once

#include "solver/examples/city_materials.h"

namespace modelsynth::examples {

// The clock tower, two cells by two: its quarters face east and north.

[[nodiscard]] MeshBuilder make_tower_ground(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_tower_shaft(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_tower_belfry(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_tower_spire(const CityMaterials& materials);

}  // namespace modelsynth::examples
