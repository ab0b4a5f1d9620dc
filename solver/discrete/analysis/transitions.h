#pragma once

#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/discrete/example.h"

#include <array>
#include <cstddef>

namespace modelsynth::discrete {

// All of an example that what can be proved of it depends on: which labels may be neighbours.
struct Transitions {
    Relations relations;  // of the six directions, numbered as these
    LabelSet labels;      // those that may be used at all
    // Axes x, y, z along which any two labels may be neighbours. Along another one a model has one
    // cell: an example of one floor is planar.
    std::array<bool, 3> open = {};

    [[nodiscard]] std::size_t open_count() const {
        return std::size_t{open[0]} + std::size_t{open[1]} + std::size_t{open[2]};
    }
};

// The labels that stand in the example or in its `adjacency`, less those of weight 0, and the
// transition matrices T_x, T_y, T_z (thesis Eq. 3.2). Sides are free: the example's boundary is
// not part of it.
[[nodiscard]] Transitions read_transitions(const Example& example);

// The same of relations made by other means.
// Requires: six relations, numbered as the directions; labels.label_count() that of the relations
//           (checked).
[[nodiscard]] Transitions make_transitions(Relations relations, LabelSet labels);

}  // namespace modelsynth::discrete
