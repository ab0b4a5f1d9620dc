#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/reading/reading.h"

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace modelsynth::proto {

inline constexpr double kMetresMax = 1e5;

// Three numbers of at most that size either way.
[[nodiscard]] std::optional<continuous::Point> read_point(const Value& value, double extent_max);
[[nodiscard]] OrderedJson write_point(const continuous::Point& point);

// Three numbers that are not all 0.
[[nodiscard]] std::optional<std::array<double, 3>> read_normal(const Value& value);

// Three lengths above 0, in metres.
[[nodiscard]] std::optional<std::array<double, 3>> read_metre_size(const Value& value);

// What stands under `parameters` of a continuous job, each field in place of that of `parameters`;
// faults are noted in the value's list.
[[nodiscard]] continuous::Parameters read_continuous_parameters(
    const Value& value, const RequestLimits& limits, continuous::Parameters parameters
);

// The inverse, every default written out. Requires: defaults filled in.
[[nodiscard]] OrderedJson write_parameters(const continuous::Parameters& parameters);

// A whole example object of kind "continuous", read to the last figure; null when there are faults.
[[nodiscard]] std::shared_ptr<const continuous::ExampleReading> read_solids(
    const Value& value, const RequestLimits& limits
);

// The inverse.
[[nodiscard]] OrderedJson write_solids(const continuous::Example& given);

// What a list shows of an example; its resource has all of it besides.
[[nodiscard]] OrderedJson solids_summary(
    const continuous::ExampleReading& reading, const std::string& id, bool built_in
);
[[nodiscard]] OrderedJson solids_resource(
    const continuous::ExampleReading& reading, const std::string& id, bool built_in
);

}  // namespace modelsynth::proto
