#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/example.h"

#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>

namespace modelsynth::testing {

// Re-verifies a model from labels and example alone, with none of the solver's code: every pair
// of neighbours of the model is a pair of neighbours of the example along the same axis (Eq. 3.1
// of the thesis, by search instead of matrices). What is wrong, or nothing.
inline std::optional<std::string> find_inconsistency(
    const discrete::Example& example,
    const GridSize& size,
    std::span<const Label> labels,
    const std::array<bool, 3>& periodic = {false, false, false}
) {
    using Pair = std::tuple<int, int, int>;  // axis, lower, upper
    std::set<Pair> allowed;
    const auto visit_pairs = [](const GridSize& grid,
                                std::span<const Label> cells,
                                const std::array<bool, 3>& wraps,
                                const auto& visit) {
        for (int y = 0; y < grid.y; ++y) {
            for (int z = 0; z < grid.z; ++z) {
                for (int x = 0; x < grid.x; ++x) {
                    const auto at = [&](int i, int j, int k) {
                        return cells[static_cast<std::size_t>(i + grid.x * (k + grid.z * j))];
                    };
                    const int here = at(x, y, z);
                    if (x + 1 < grid.x || wraps[0]) {
                        visit(Pair{0, here, at((x + 1) % grid.x, y, z)}, x, y, z);
                    }
                    if (y + 1 < grid.y || wraps[1]) {
                        visit(Pair{1, here, at(x, (y + 1) % grid.y, z)}, x, y, z);
                    }
                    if (z + 1 < grid.z || wraps[2]) {
                        visit(Pair{2, here, at(x, y, (z + 1) % grid.z)}, x, y, z);
                    }
                }
            }
        }
    };
    visit_pairs(
        example.size,
        example.cells,
        {false, false, false},
        [&allowed](const Pair& pair, int, int, int) { allowed.insert(pair); }
    );
    for (const auto& pair : example.adjacency) {
        allowed.insert({pair.axis, pair.lower, pair.upper});
    }
    if (labels.size() != size.cell_count()) {
        return "the model has " + std::to_string(labels.size()) + " labels";
    }
    for (const Label label : labels) {
        if (label >= example.pieces.size()) {
            return "a cell has no label";
        }
    }
    std::optional<std::string> fault;
    visit_pairs(size, labels, periodic, [&](const Pair& pair, int x, int y, int z) {
        if (!fault && !allowed.contains(pair)) {
            const auto& [axis, lower, upper] = pair;
            fault = "at [" + std::to_string(x) + ", " + std::to_string(y) + ", " +
                    std::to_string(z) + "] along axis " + std::to_string(axis) + ": " +
                    example.pieces[static_cast<std::size_t>(lower)].name + " beside " +
                    example.pieces[static_cast<std::size_t>(upper)].name;
        }
    });
    return fault;
}

}  // namespace modelsynth::testing
