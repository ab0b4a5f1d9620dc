#pragma once

#include "solver/core/label_set.h"
#include "solver/core/topology.h"
#include "solver/discrete/explanation/effort.h"
#include "solver/discrete/problem.h"

#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// Cells of a whole without a model at which it shows: were all other cells free to take any label
// of `everything`, there would be none either. As few as were found, in the order of flat arrays;
// none when no cell is needed, or when the effort does not suffice.
// `emptied` is where propagation found nothing left, if it did: then a box around it is looked at
// first, so that the cost does not go with the size of the whole.
// Deterministic.
[[nodiscard]] std::vector<Site> find_conflict_cells(
    const Problem& problem,
    const LabelSet& everything,
    std::optional<Site> emptied,
    Effort& effort,
    const std::stop_token& stop
);

}  // namespace modelsynth::discrete
