#pragma once

#include <cstddef>
#include <vector>

namespace modelsynth::continuous {

// The planes of one family that cut a box, by their offsets, rising.
using PlaneOffsets = std::vector<double>;

// Of one family.
inline constexpr std::size_t kPlanesMax = 65535;

}  // namespace modelsynth::continuous
