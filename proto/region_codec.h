#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/core/masks.h"
#include "solver/discrete/parameters.h"

#include <optional>
#include <vector>

namespace modelsynth::proto {

// The fields box, cells, mask and voxels of an object; what is wrong goes to its faults.
[[nodiscard]] discrete::Region read_region(ObjectReader& reader, const RequestLimits& limits);

// Puts the fields of a region with what is written of the object.
void write_region(const discrete::Region& region, OrderedJson& written);

// The elements of a list of constraints, when there are not too many of them, nor of the masks and
// symmetries among them, which are counted before any is unpacked.
[[nodiscard]] std::optional<std::vector<Value>> constraint_values(
    const Value& list, const RequestLimits& limits
);

// Its last two by themselves, as other regions have them.
[[nodiscard]] std::optional<Mask> read_mask(const Value& value, const RequestLimits& limits);
[[nodiscard]] std::optional<Voxels> read_voxels(const Value& value, const RequestLimits& limits);
void write_fields(
    const std::optional<Mask>& mask, const std::optional<Voxels>& voxels, OrderedJson& written
);

[[nodiscard]] OrderedJson write_cell(const Cell& cell);

}  // namespace modelsynth::proto
