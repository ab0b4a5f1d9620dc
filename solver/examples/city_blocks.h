#pragma once

#include "solver/examples/city_materials.h"

namespace modelsynth::examples {

// Stone-faced blocks: shops below, offices and flats above.
// Sides are built facing east, corners facing east and north.

[[nodiscard]] MeshBuilder make_shop(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_shop_corner(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_core(const CityMaterials& materials);

[[nodiscard]] MeshBuilder make_block_wall(
    const CityMaterials& materials, MaterialId wall, bool has_balcony
);
[[nodiscard]] MeshBuilder make_block_corner(const CityMaterials& materials, MaterialId wall);
// Brick between wide workshop windows, on the same ground floors and under the same roofs.
[[nodiscard]] MeshBuilder make_loft_wall(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_loft_corner(const CityMaterials& materials);

}  // namespace modelsynth::examples
