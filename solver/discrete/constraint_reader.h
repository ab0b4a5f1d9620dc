#pragma once

#include "solver/core/constraints/constraint_board.h"
#include "solver/core/result.h"
#include "solver/core/weight_tables.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/problem.h"

#include <memory>
#include <span>

namespace modelsynth::discrete {

// Puts the constraints of a request into the problem, each where it tells soonest: into domains,
// into weights, or among the member rules.
// Fails: kTooLarge for too many tables of weights.
[[nodiscard]] Result<void> read_constraints(
    const Example& example, const Parameters& parameters, Problem& problem, WeightTables& weights
);

// What chooses labels where a resemblance is asked for; null otherwise. `problem` has its weights.
[[nodiscard]] std::unique_ptr<const LabelChooser> make_chooser(
    const Example& example, const Parameters& parameters, const Problem& problem
);

// The member rules of the problem, with nothing decided. The number of a constraint on the board
// is that of `rules`.
// Requires: rules of the problem, perhaps changed; the problem outlives the board.
[[nodiscard]] std::unique_ptr<ConstraintBoard> make_board(
    const Problem& problem, std::span<const MemberRule> rules
);

}  // namespace modelsynth::discrete
