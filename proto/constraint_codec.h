#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/discrete/parameters.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::proto {

// The list of constraints of a discrete synthesis; what is wrong goes to the value's faults.
[[nodiscard]] std::vector<discrete::Constraint> read_constraints(
    const Value& value, const RequestLimits& limits
);

// The field `mirror` of a symmetry; nothing where the images are to be found.
[[nodiscard]] std::optional<std::vector<std::pair<std::string, std::string>>> read_mirror(
    const Value& value, const RequestLimits& limits
);

[[nodiscard]] OrderedJson write_constraints(const std::vector<discrete::Constraint>& constraints);

}  // namespace modelsynth::proto
