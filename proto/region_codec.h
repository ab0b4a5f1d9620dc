#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/discrete/parameters.h"

namespace modelsynth::proto {

// The fields box, cells, mask and voxels of an object; what is wrong goes to its faults.
[[nodiscard]] discrete::Region read_region(ObjectReader& reader, const RequestLimits& limits);

// Puts the fields of a region with what is written of the object.
void write_region(const discrete::Region& region, OrderedJson& written);

[[nodiscard]] OrderedJson write_cell(const Cell& cell);

}  // namespace modelsynth::proto
