#pragma once

#include "solver/discrete/analysis/split_labels.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"
#include "solver/discrete/example.h"

#include <optional>

namespace modelsynth::discrete {

// Splits labels by where they stand in the example, as the thesis does (3.3.8): the cells of a
// label that takes part in a conflict become two labels, those with one of the conflict's
// neighbours after them and the others, and who may be neighbours is read from the example anew.
// Pairs of `adjacency` hold for all labels that stand for theirs. Goes on until every corner can be
// closed (Eq. 3.11; in space corners of cubes too), which comes at the latest when each cell
// has a label of its own - unless what closes a corner can itself not be gone on with.
//
// f maps neighbours to neighbours, so each model of the new labels is f^-1 of one of the example.
// The converse, the other half of Eq. 3.13, does not hold in general: labels that stood apart in
// the example may no longer meet.
//
// Returns the labels with those that are ends, see SplitLabels::remove_ends(): merging may
// bring these back. Nothing where it came to no end: no labels left, or work, or `capacity`, or
// cells to tell apart.
// Cost: a step for each label and pair of axes and for some cells, times the number of times that
//       the example is read; every label may be split each time.
[[nodiscard]] std::optional<SplitLabels> split_by_cells(
    const Example& example,
    const Transitions& transitions,
    std::size_t capacity,
    SplitOrder order,
    Work& work
);

}  // namespace modelsynth::discrete
