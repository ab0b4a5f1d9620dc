#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/registry/task.h"

#include <optional>

namespace modelsynth::proto {

// What stands under `parameters` of a discrete job, put over what is known of them before, each
// field for itself and each side of the boundary; faults are noted in the value's list.
[[nodiscard]] discrete::Parameters read_parameters(
    const Value& value, const RequestLimits& limits, discrete::Parameters parameters
);

// The inverse, every default written out. Requires: defaults filled in.
[[nodiscard]] OrderedJson write_parameters(const discrete::Parameters& parameters);

// As under `order`. Requires: one that read_parameters() gives (checked).
[[nodiscard]] const char* order_name(const discrete::CellOrder& order);

// One side: "free", "example", "periodic", a piece, or a list of pieces.
[[nodiscard]] std::optional<discrete::SideBoundary> read_side(
    const Value& value, const RequestLimits& limits
);
[[nodiscard]] OrderedJson write_side(const discrete::SideBoundary& side);

// A whole example object of kind "discrete".
[[nodiscard]] std::optional<discrete::Example> read_example(
    const Value& value, const RequestLimits& limits
);

// A whole example object of the kind that it says.
[[nodiscard]] std::optional<Example> read_any_example(
    const Value& value, const RequestLimits& limits
);

}  // namespace modelsynth::proto
