#pragma once

#include "solver/continuous/example.h"

namespace modelsynth::continuous {

// The spacing of an example that does not say one, metres: the least distance between two parallel
// planes of faces (and the ground's) that is more than a thousandth of the extent, so that the
// thinnest of its parts can stand anywhere. 1 where no two are parallel.
// Requires: corner numbers in range (find_solid_faults()). Cost: that of find_families().
[[nodiscard]] double default_spacing(const Example& example);

}  // namespace modelsynth::continuous
