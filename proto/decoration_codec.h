#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "solver/continuous/example.h"

#include <vector>

namespace modelsynth::proto {

// What stands under `decorations` of an object of solids; what is wrong goes to the value's faults.
// Requires: all objects of the example have their names.
[[nodiscard]] std::vector<continuous::Decoration> read_decorations(
    const Value& given, const continuous::Example& example
);

[[nodiscard]] OrderedJson write_decorations(
    const std::vector<continuous::Decoration>& decorations, const continuous::Example& example
);

}  // namespace modelsynth::proto
