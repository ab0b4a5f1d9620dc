#pragma once

#include "solver/examples/city_materials.h"

#include <cstdint>

namespace modelsynth::examples {

// Old houses, two cells deep, plastered below and half-timbered above, under tiled gable roofs.
// Sides are built facing east, corners facing east and north.

[[nodiscard]] MeshBuilder make_house_front(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_house_door(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_house_ground_corner(const CityMaterials& materials);
enum class HouseStorey : std::uint8_t { kGround, kMiddle, kTimber };
[[nodiscard]] MeshBuilder make_house_wall(const CityMaterials& materials, HouseStorey storey);
[[nodiscard]] MeshBuilder make_house_corner(const CityMaterials& materials, HouseStorey storey);

// Half of a roof, falling to the east from a ridge on the west wall of the cell.
[[nodiscard]] MeshBuilder make_slope(const CityMaterials& materials, bool has_dormer);
// ... that ends in a gable on the north (left) or south (right).
[[nodiscard]] MeshBuilder make_gable(const CityMaterials& materials, bool is_left);

}  // namespace modelsynth::examples
