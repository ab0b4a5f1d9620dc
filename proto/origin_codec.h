#pragma once

// Private to proto's sources.

#include "proto/job_request.h"
#include "proto/json.h"
#include "proto/limits.h"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

// What stands under `from`, in two steps, since the job that it names tells which solver's places
// the rest is about. Faults are noted in the value's list.
class OriginReader {
  public:
    OriginReader(const Value& value, const RequestLimits& limits)
        : limits_(limits), fields_(value) {}

    // The job and which of its models.
    [[nodiscard]] JobOrigin read_job();

    // The rest. `names_size`: the size has to be told, since there is nobody to ask.
    void read_places(std::string_view solver, bool names_size, JobOrigin& from);

  private:
    const RequestLimits& limits_;
    ObjectReader fields_;
};

[[nodiscard]] OrderedJson write_origin(const JobOrigin& from);

// Makes it the size of the model made with those parameters. False when the origin tells another.
[[nodiscard]] bool take_size(const Parameters& earlier, Origin& origin);

// What keeps the request from starting there; pointers are of the request. Nothing is said of an
// origin without a size.
// Requires: defaults filled in; for solids, nothing is wrong with the parameters. The earlier
// parameters may be null.
[[nodiscard]] std::vector<Fault> find_origin_faults(
    const Task& task, const Origin& origin, const Parameters* earlier
);

// What was asked of the older model, asked of one of another size: constraints go with their
// places, and a symmetry about the older model's middle stays there. Fails: with the position of
// one that cannot, since a mask and voxels are stretched over the whole model and the middle of
// solids is that of the model.
[[nodiscard]] tl::expected<std::vector<discrete::Constraint>, std::size_t> moved_constraints(
    std::vector<discrete::Constraint> constraints, const discrete::Origin& origin
);
[[nodiscard]] tl::expected<std::vector<continuous::Constraint>, std::size_t> moved_constraints(
    std::vector<continuous::Constraint> constraints, const continuous::Origin& origin
);

// Whether the older model lies inside one of that size.
[[nodiscard]] bool lies_within(const discrete::Origin& origin, const GridSize& model);

}  // namespace modelsynth::proto
