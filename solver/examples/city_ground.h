#pragma once

#include "solver/examples/city_materials.h"

#include <array>
#include <cstdint>

namespace modelsynth::examples {

// What lies between the buildings: streets, paved places, lawns.

// Which sides a street leaves by: east, north, west, south.
using StreetArms = std::array<bool, 4>;
inline constexpr StreetArms kArmsStraight = {true, false, true, false};
inline constexpr StreetArms kArmsTurn = {true, true, false, false};
inline constexpr StreetArms kArmsFork = {false, true, true, true};
inline constexpr StreetArms kArmsCrossing = {true, true, true, true};

enum class StreetPart : std::uint8_t { kMarking, kLamps, kZebra, kCar };
[[nodiscard]] MeshBuilder make_street(const CityMaterials& materials, const StreetArms& arms);
// A street along x with something on it.
[[nodiscard]] MeshBuilder make_straight(const CityMaterials& materials, StreetPart part);

enum class PavingPart : std::uint8_t { kNone, kLamp, kTree, kBench, kPuddle };
[[nodiscard]] MeshBuilder make_paving(const CityMaterials& materials, PavingPart part);

enum class LawnPart : std::uint8_t { kNone, kTree, kShrubs, kFountain };
[[nodiscard]] MeshBuilder make_lawn(const CityMaterials& materials, LawnPart part);
// A hedge and a kerb on the east, or on the east and north.
[[nodiscard]] MeshBuilder make_lawn_edge(const CityMaterials& materials);
[[nodiscard]] MeshBuilder make_lawn_corner(const CityMaterials& materials);

}  // namespace modelsynth::examples
