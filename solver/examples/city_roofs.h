#pragma once

#include "solver/examples/city_materials.h"

#include <cstdint>

namespace modelsynth::examples {

// The mansard roofs of blocks: slopes of slate or tile round a flat deck, and what breaks their
// line against the sky. A roof fills the cell above the highest storey. Sides are built facing
// east, corners facing east and north.

enum class RoofPart : std::uint8_t { kHatch, kCupola, kGarden, kLight };
[[nodiscard]] MeshBuilder make_flat_roof(const CityMaterials& materials, RoofPart part);
[[nodiscard]] MeshBuilder make_mansard(
    const CityMaterials& materials, MaterialId cover, bool has_dormer
);
[[nodiscard]] MeshBuilder make_mansard_corner(const CityMaterials& materials, MaterialId cover);

}  // namespace modelsynth::examples
