#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/continuous/constraints/constraints.h"

#include <vector>

namespace modelsynth::proto {

// The list of constraints of a continuous synthesis; what is wrong goes to the value's faults.
[[nodiscard]] std::vector<continuous::Constraint> read_solid_constraints(
    const Value& value, const RequestLimits& limits
);

[[nodiscard]] OrderedJson write_constraints(const std::vector<continuous::Constraint>& constraints);

// The fields box, mask and voxels of an object; what is wrong goes to its faults.
[[nodiscard]] continuous::Region read_metre_region(
    ObjectReader& reader, const RequestLimits& limits
);

// Puts the fields of a region with what is written of the object.
void write_region(const continuous::Region& region, OrderedJson& written);

}  // namespace modelsynth::proto
