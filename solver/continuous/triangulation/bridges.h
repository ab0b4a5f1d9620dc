#pragma once

#include "solver/continuous/triangulation/rings.h"

namespace modelsynth::continuous::rings {

// Joins every hole to an outer boundary by an edge there and back, so that no holes are left.
// Requires: corners face the inside. Cost: O(holes * corners).
void bridge_holes(const Places& places, Corners& corners);

}  // namespace modelsynth::continuous::rings
