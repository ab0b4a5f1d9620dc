#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/analysis/completion.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"

#include <cstddef>
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
//
// `core` has those of the cells that alone, with the choice if there is one, already have no
// completion: the same partial model without what does not matter. It is as small as a little work
// can make it, and what is best shown.
struct Counterexample {
    GridSize box;
    std::vector<PlacedLabel> cells;  // in the order in which they were placed
    std::optional<PlacedLabel> choice;
    std::vector<PlacedLabel> core;  // in that order too
};

struct CounterexampleSearch {
    std::uint32_t runs =
        16;  // in every box; then in another pass 4 times, in a last one 16 times as many
    std::size_t box_cells_max = 1000;
    std::uint64_t seed = 0;
};

// Looks for a counterexample by runs of Algorithm 3.1 with random choices, in boxes of rising
// size, in up to three passes: the box of the answer is the smallest in which its pass saw one. One
// without `choice` is looked for until the end; where none is seen, the first one with it is the
// answer. The cells of one without are as few as the work allows. Ensures:  deterministic in its
// arguments. Nothing when none was seen, which proves nothing. Cost:     a step a cell at most; in
// the plane boxes have no more than 256 cells. Thread-safe.
[[nodiscard]] std::optional<Counterexample> find_counterexample(
    const Transitions& transitions, const CounterexampleSearch& search, Work& work
);

}  // namespace modelsynth::discrete
