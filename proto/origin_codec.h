#pragma once

// Private to proto's sources.

#include "proto/job_request.h"
#include "proto/json.h"
#include "proto/limits.h"

#include <vector>

namespace modelsynth::proto {

// What stands under `from`; faults are noted in the value's list. `names_all`: the size has to be
// told, since there is nobody to ask.
[[nodiscard]] JobOrigin read_origin(
    const Value& value, const RequestLimits& limits, bool names_all
);

[[nodiscard]] OrderedJson write_origin(const JobOrigin& from);

// Whether the older model lies inside one of that size.
[[nodiscard]] bool lies_within(const discrete::Origin& origin, const GridSize& model);

// Where it does not, and what of the region does not. Pointers are of the request.
[[nodiscard]] std::vector<Fault> find_origin_faults(const JobOrigin& from, const GridSize& model);

// What was asked of the older model, asked of one of another size: constraints go with their
// places, and a symmetry about the older model's middle stays there. Fails: with the position of
// one that cannot, since a mask and voxels are stretched over the whole model.
[[nodiscard]] tl::expected<std::vector<discrete::Constraint>, std::size_t> moved_constraints(
    std::vector<discrete::Constraint> constraints, const discrete::Origin& origin
);

}  // namespace modelsynth::proto
