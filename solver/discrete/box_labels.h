#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"

#include <cstddef>
#include <span>
#include <vector>

namespace modelsynth::discrete {

// The labels of a box of a model, x fastest, then z, then y: out of the model and back into it.

inline void copy_out(
    const GridSize& size, std::span<const Label> model, const Box& box, std::vector<Label>& labels
) {
    labels.clear();
    for_each_cell(box, [&](const Cell& cell) { labels.push_back(model[size.index(cell)]); });
}

inline void copy_in(
    const GridSize& size, std::span<const Label> labels, const Box& box, std::span<Label> model
) {
    std::size_t i = 0;
    for_each_cell(box, [&](const Cell& cell) { model[size.index(cell)] = labels[i++]; });
}

}  // namespace modelsynth::discrete
