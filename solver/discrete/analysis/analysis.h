#pragma once

#include "solver/core/grid.h"
#include "solver/core/result.h"
#include "solver/discrete/analysis/infallibility.h"
#include "solver/discrete/analysis/label_facts.h"
#include "solver/discrete/analysis/label_splitting.h"
#include "solver/discrete/analysis/model_count.h"
#include "solver/discrete/analysis/success_curve.h"
#include "solver/discrete/analysis/warnings.h"
#include "solver/discrete/example.h"

#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

struct CountedSize {
    GridSize size;
    ModelCount models;
};

// All that is said of an example before anything is made of it, with its own boundary, default
// size and weights.
struct Analysis {
    InfallibilityVerdict verdict;
    std::optional<Splitting> splitting;  // looked for where the verdict is not infallible
    LabelFacts facts;
    std::vector<Warning> warnings;
    std::vector<SuccessPoint> success;
    std::vector<CountedSize> counts;  // along axes that have no neighbours one cell
};

// Ensures: deterministic.
// Fails:   kCancelled when `stop` is requested.
// Cost:    bounded; about a second for a hundred labels, less work is done where labels are more.
//          Thread-safe.
[[nodiscard]] Result<Analysis> analyse(const Example& example, const std::stop_token& stop);

}  // namespace modelsynth::discrete
