#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/core/block_schedule.h"

#include <optional>

namespace modelsynth::proto {

// What stands under `parameters.blocks`, where a field is absent as in `blocks`: null for none;
// faults are noted in the value's list.
[[nodiscard]] std::optional<Blocks> read_blocks(
    const Value& value, const RequestLimits& limits, Blocks blocks
);

[[nodiscard]] OrderedJson write_blocks(const std::optional<Blocks>& blocks);

}  // namespace modelsynth::proto
