#pragma once

#include "solver/core/grid.h"
#include "solver/core/result.h"
#include "solver/discrete/analysis/transitions.h"

#include <cstddef>
#include <cstdint>
#include <stop_token>

namespace modelsynth::discrete {

// How many models are consistent with an example: D_E(n_x, n_y, n_z) of the thesis (3.2).
struct ModelCount {
    std::uint64_t count = 0;
    bool is_exact = true;  // false: there are at least as many

    friend bool operator==(const ModelCount&, const ModelCount&) = default;
};

struct ModelCountLimit {
    // Labellings of a cross-section kept at a time; beyond, models are counted one by one.
    std::size_t profiles_max = std::size_t{1} << 16;
    // Cases looked at, of a cross-section or of a model.
    std::uint64_t steps_max = 4'000'000;
};

// Larger models are refused.
inline constexpr std::size_t kCountedCellsMax = 4096;

// Models of the size with all sides free. A cell is added at a time; models alike in the
// cells that later ones touch, a cross-section, are counted together (the transfer matrix method).
// Where that passes the limit, models are found one after the other until the work is used up.
// A size of several cells along an axis that is not open has no models.
// Requires: extents positive (checked).
// Ensures:  deterministic. A count of 2^64-1 that is not exact: larger than it can hold.
// Fails:    kTooLarge beyond kCountedCellsMax, kCancelled when `stop` is requested.
// Cost:     O(cells * profiles * labels). Thread-safe.
[[nodiscard]] Result<ModelCount> count_models(
    const Transitions& transitions,
    const GridSize& size,
    const ModelCountLimit& limit,
    const std::stop_token& stop
);

}  // namespace modelsynth::discrete
