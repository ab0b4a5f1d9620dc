#pragma once

#include "solver/discrete/box_search.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <span>
#include <stop_token>

namespace modelsynth::discrete {

// Where a consistent model has fewer of some pieces than a count asks for, puts more of them in,
// one at a time at places drawn at random, each by making a block around it anew.
// `search` is one of the problem's. Deterministic in (problem, model, block, seed).
// Ensures: the model is consistent, and no constraint is violated that was not.
// False:   some count is not reached; the model is as far as it came.
[[nodiscard]] bool plant_counts(
    const Problem& problem,
    BoxSearch& search,
    const GridSize& block,
    std::uint64_t seed,
    std::span<Label> model,
    const std::stop_token& stop
);

}  // namespace modelsynth::discrete
