#pragma once

#include "solver/core/grid.h"
#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// How often models of one size succeeded.
struct SuccessPoint {
    GridSize size;
    std::uint32_t runs = 0;       // >= 1
    std::uint32_t successes = 0;  // of the runs

    friend bool operator==(const SuccessPoint&, const SuccessPoint&) = default;
};

struct SuccessOptions {
    std::vector<std::int32_t> widths = {5, 10, 15, 20, 30, 40};  // cells along x and z
    std::uint32_t runs = 20;                                     // for every size
    std::uint64_t seed = 0;
    // Of all runs together. A size gets as many runs as are left of it, and is left out when that
    // is none.
    std::uint64_t cells_max = 10'000'000;
};

// The curve of the thesis's Fig. 3.8: how often the whole model at once succeeds at the first
// attempt with nothing taken back, by size. The height and the boundary are those of `parameters`,
// so are order and weights; its width, depth, blocks and constraints are not looked at. As
// everywhere in this project a label that propagation refutes at once is replaced by another one;
// the thesis's Algorithm 3.1 fails there, so its curve lies below.
// A size for which propagation of the boundary alone finds a contradiction has no successes.
// Requires: parameters with defaults filled in, of which find_faults() has nothing to say but of
//           constraints; widths positive (both checked).
// Ensures:  deterministic in its arguments: run i of a size depends on (seed, i, the size) alone.
// Fails:    kCancelled when `stop` is requested.
// Cost:     a whole model for every run; at most cells_max cells. Memory: a catalog of the largest
//           size. Thread-safe.
[[nodiscard]] Result<std::vector<SuccessPoint>> measure_success(
    const Example& example,
    const Parameters& parameters,
    const SuccessOptions& options,
    const std::stop_token& stop
);

}  // namespace modelsynth::discrete
