#pragma once

#include "solver/continuous/triangulation/rings.h"

#include <array>
#include <cstdint>
#include <vector>

namespace modelsynth::continuous::rings {

// Cuts ears until nothing is left, the best shaped first; the triangles, by numbers of points.
// Where nothing is strictly an ear, because the rings break the rules or for want of precision, the
// least bad corner is cut, so that it always ends.
// Requires: rings without holes, whose corners face the inside.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> cut_ears(
    const Places& places, Corners& corners
);

}  // namespace modelsynth::continuous::rings
