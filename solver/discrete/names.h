#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/example.h"
#include "solver/discrete/problem.h"

#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

// From names to what they stand for, and back. Thread-safe.

using LabelOfName = std::unordered_map<std::string, Label>;

[[nodiscard]] LabelOfName labels_by_name(const Example& example);

// Requires: every name is known.
[[nodiscard]] LabelSet set_of(const LabelOfName& labels, const std::vector<std::string>& names);

// Requires: every name is known.
[[nodiscard]] std::vector<std::pair<Label, Label>> pairs_of(
    const LabelOfName& labels, std::span<const std::pair<std::string, std::string>> names
);

// "tower", "wall" and "gate": names of pieces as a person reads them, at most eight.
[[nodiscard]] std::string list_names(const Example& example, const LabelSet& labels);

// "a, b and c".
[[nodiscard]] std::string join_words(const std::vector<std::string>& words);

// "[1, 0, 3]".
[[nodiscard]] std::string name_cell(const Cell& cell);

// The outermost layer of a grid on one side.
[[nodiscard]] Box layer(const GridSize& size, std::size_t side);

// What a side's boundary lets stand in its layer; free sides let everything.
// Requires: every piece that it names is known.
[[nodiscard]] LabelSet allowed_on_side(
    const Example& example,
    const LabelOfName& labels,
    std::size_t side,
    const SideBoundary& boundary
);

// The sides of a grid that a cell lies on: "the bottom and north sides"; empty: none.
[[nodiscard]] std::string name_sides(const GridSize& size, const Cell& cell);

// "constraint 2 (count of "tower" and "gate")": as a person reads it.
[[nodiscard]] std::string name_rule(const Example& example, const MemberRule& rule);

}  // namespace modelsynth::discrete
