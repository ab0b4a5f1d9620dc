#pragma once

#include <cstdint>

namespace modelsynth::discrete {

// RandomKey::block of searches that are no block of the schedule, which has far fewer.
inline constexpr std::uint32_t kWholeKey = 0xFFFFFFFF;
inline constexpr std::uint32_t kTileKey = 0xFFFFFFFE;
inline constexpr std::uint32_t kMendKey = 0xFFFFFFFD;
inline constexpr std::uint32_t kPlantKeys = 0x80000000;  // from here on
inline constexpr std::uint32_t kProbeKeys = 0xF0000000;  // likewise

}  // namespace modelsynth::discrete
