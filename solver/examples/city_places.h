#pragma once

#include "solver/examples/city_materials.h"

#include <cstdint>

namespace modelsynth::examples {

// Where one walks between streets and buildings. Edges are built facing east, corners facing east
// and north.

enum class LanePart : std::uint8_t { kNone, kTree, kBigTree, kBench, kDrain };
[[nodiscard]] MeshBuilder make_lane(const CityMaterials& materials, LanePart part);
// A broad pavement with the street in the east: a tree and a table.
[[nodiscard]] MeshBuilder make_verge(const CityMaterials& materials);

// A market square: bollards along its edges, stalls or a fountain in the middle.
[[nodiscard]] MeshBuilder make_square_edge(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_square_corner(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_square_middle(const CityMaterials& materials, bool has_fountain);

enum class LawnPart : std::uint8_t { kTree, kFlowers };
[[nodiscard]] MeshBuilder make_lawn(const CityMaterials& materials, LawnPart part);
// A hedge and a kerb on the east, or on the east and north.
[[nodiscard]] MeshBuilder make_lawn_edge(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_lawn_corner(const CityMaterials& materials);

// A house's garden, open in the west, fenced in the east and at an end in the north (left) or
// south (right).
enum class GardenEnd : std::uint8_t { kNone, kLeft, kRight };
[[nodiscard]] MeshBuilder make_garden(const CityMaterials& materials, GardenEnd end);

}  // namespace modelsynth::examples
