#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace modelsynth::discrete {

// The labels of a box of a model, x fastest, then z, then y: out of the model and back into it.

inline void copy_out(
    const GridSize& size, std::span<const Label> model, const Box& box, std::vector<Label>& labels
) {
    labels.resize(box.size().cell_count());
    auto out = labels.begin();
    for_each_row(box, [&](const Cell& first, std::size_t count) {
        out = std::copy_n(&model[size.index(first)], count, out);
    });
}

inline void copy_in(
    const GridSize& size, std::span<const Label> labels, const Box& box, std::span<Label> model
) {
    // Rows of a large model are far from each other: together they come sooner than in turn.
    for_each_row(box, [&](const Cell& first, std::size_t) {
        __builtin_prefetch(&model[size.index(first)], 1);
    });
    auto in = labels.begin();
    for_each_row(box, [&](const Cell& first, std::size_t count) {
        std::copy_n(in, count, &model[size.index(first)]);
        in += static_cast<std::ptrdiff_t>(count);
    });
}

}  // namespace modelsynth::discrete
