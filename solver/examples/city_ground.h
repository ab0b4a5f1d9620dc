#pragma once

#include "solver/examples/city_materials.h"

#include <array>
#include <cstdint>

namespace modelsynth::examples {

// Streets with their kerbs and pavements, one cell wide.

// Which sides a street leaves by: east, north, west, south.
using StreetArms = std::array<bool, 4>;
inline constexpr StreetArms kArmsEnd = {true, false, false, false};
inline constexpr StreetArms kArmsStraight = {true, false, true, false};
inline constexpr StreetArms kArmsTurn = {true, true, false, false};
inline constexpr StreetArms kArmsFork = {false, true, true, true};
inline constexpr StreetArms kArmsCrossing = {true, true, true, true};

// A zebra crossing lies towards the junction in the east.
enum class StreetPart : std::uint8_t { kMarking, kLamps, kZebra, kCar };
[[nodiscard]] MeshBuilder make_street(const CityMaterials& materials, const StreetArms& arms);
// A street along x with something on it.
[[nodiscard]] MeshBuilder make_straight(const CityMaterials& materials, StreetPart part);
// A street from the east that ends at bollards.
[[nodiscard]] MeshBuilder make_street_end(const CityMaterials& materials);

}  // namespace modelsynth::examples
