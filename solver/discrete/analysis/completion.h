#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"

#include <cstdint>
#include <span>

namespace modelsynth::discrete {

// A label at a cell; some of them are a partial model.
struct PlacedLabel {
    Cell cell;
    Label label = 0;

    friend bool operator==(const PlacedLabel&, const PlacedLabel&) = default;
};

enum class Completion : std::uint8_t {
    kExists,
    kNone,     // proved by exhaustive search
    kUnknown,  // the work was used up, or stopped
};

// Whether a partial model of the box, sides free, can be completed (thesis 3.1: whether it is
// consistent, which is NP-complete, Theorem 3.3.4): by search of all cases, each narrowed by arc
// consistency.
// Requires: extents positive, cells inside (checked); a label that may not be used is no
//           completion.
// Cost: one step a case. Thread-safe.
[[nodiscard]] Completion find_completion(
    const Transitions& transitions,
    const GridSize& box,
    std::span<const PlacedLabel> placed,
    Work& work
);

}  // namespace modelsynth::discrete
