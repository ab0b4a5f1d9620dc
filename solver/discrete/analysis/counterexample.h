#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/analysis/completion.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace modelsynth::discrete {

// A state of Algorithm 3.1 that shows an example to be fallible (thesis 3.3.4): the first cells of
// a small box, sides free, in the order of column_order(), with labels each of which the catalog
// offered. With these labels every cell of the box has labels left by arc consistency.
//
// Without `choice`, no model completes `cells` (Fig. 3.6): C is not empty though C* is.
// With `choice`, the catalog offers that label for the next cell, and no model completes `cells`
// with it (Fig. 3.5): C differs from C*. Arc consistency notices as soon as the label is placed,
// and a search that tries another label then, as the project's does, goes on.
struct Counterexample {
    GridSize box;
    std::vector<PlacedLabel> cells;  // in the order in which they were placed
    std::optional<PlacedLabel> choice;
};

struct CounterexampleSearch {
    std::uint32_t runs = 16;  // in every box
    std::uint64_t seed = 0;
};

// Looks for a counterexample by runs of Algorithm 3.1 with random choices, in boxes of rising
// size: the box of the answer is the smallest in which one was seen. One without `choice` is
// looked for longest; where none is seen, the first one with it is the answer. The cells of one
// without are as few as the work allows.
// Ensures:  deterministic in its arguments. Nothing when none was seen, which proves nothing.
// Cost:     two steps a cell; boxes have up to 1 000 cells (up to 256 in the plane). Thread-safe.
[[nodiscard]] std::optional<Counterexample> find_counterexample(
    const Transitions& transitions, const CounterexampleSearch& search, Work& work
);

}  // namespace modelsynth::discrete
