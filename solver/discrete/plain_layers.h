#pragma once

#include "solver/core/label_set.h"
#include "solver/discrete/example.h"
#include "solver/discrete/problem.h"

#include <optional>
#include <vector>

namespace modelsynth::discrete {

// What most cells of each floor may be, of those that are not kept.
// Shape: by floor, from the bottom up.
[[nodiscard]] std::vector<LabelSet> common_domains(const Problem& problem);

// One label a floor, each next to itself along x and z and its own image under every symmetry,
// chosen so that as much as possible is empty and the rest is common. Nothing when there is none.
// Shape: by floor.
[[nodiscard]] std::optional<std::vector<Label>> find_layers(
    const Example& example, const Problem& problem
);

// The model whose floors are these.
[[nodiscard]] std::vector<Label> spread_layers(
    const Problem& problem, const std::vector<Label>& layers
);

}  // namespace modelsynth::discrete
