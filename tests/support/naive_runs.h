#pragma once

#include "solver/core/grid.h"
#include "solver/core/random.h"
#include "solver/discrete/example.h"
#include "tests/support/naive_grid.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth::testing {

// Algorithm 3.1 with free sides over tiny grids, on naive arc consistency.

// Cells in the order that the verdict is about.
inline std::vector<Cell> scan(const GridSize& size) {
    std::vector<Cell> cells;
    for (std::int32_t x = 0; x < size.x; ++x) {
        for (std::int32_t z = 0; z < size.z; ++z) {
            for (std::int32_t y = 0; y < size.y; ++y) {
                cells.push_back({x, y, z});
            }
        }
    }
    return cells;
}

// Every run of Algorithm 3.1 there is, until `states` of them were looked at: whether none fails.
inline bool never_fails(
    const NaiveGrid& grid, const std::vector<Cell>& cells, std::size_t next, std::size_t& states
) {
    if (next == cells.size()) {
        return true;
    }
    const std::uint32_t offered = NaiveGrid(grid).at(cells[next]);
    for (std::uint32_t bit = 1; bit <= offered; bit <<= 1) {
        if ((offered & bit) == 0 || states == 0) {
            continue;
        }
        --states;
        NaiveGrid with = grid;
        with.at(cells[next]) = bit;
        if (!with.propagate() || !never_fails(with, cells, next + 1, states)) {
            return false;
        }
    }
    return true;
}

// A random run of Algorithm 3.1: whether it comes to its end.
inline bool run_succeeds(const NaiveGrid& start, const GridSize& size, RandomStream& random) {
    NaiveGrid grid = start;
    for (const Cell& cell : scan(size)) {
        std::uint32_t& set = grid.at(cell);
        for (auto skip = random.below(static_cast<std::uint32_t>(std::popcount(set))); skip > 0;
             --skip) {
            set &= set - 1;
        }
        set &= ~set + 1;  // the lowest that is left
        if (!grid.propagate()) {
            return false;
        }
    }
    return true;
}

inline void expect_never_fails(
    const discrete::Example& example,
    const std::vector<GridSize>& small,
    const std::vector<GridSize>& large,
    std::uint64_t seed
) {
    const NaiveRules rules(example);
    const auto sized = [&rules](GridSize size) {
        size.x = rules.is_open(0) ? size.x : 1;
        size.y = rules.is_open(1) ? size.y : 1;
        size.z = rules.is_open(2) ? size.z : 1;
        return size;
    };
    for (const GridSize& each : small) {
        const GridSize size = sized(each);
        NaiveGrid start(rules, size);
        std::size_t states = 300;
        if (start.propagate()) {
            ASSERT_TRUE(never_fails(start, scan(size), 0, states)) << "seed " << seed;
        }
    }
    RandomStream random({seed, 0, 0, 97});
    for (const GridSize& each : large) {
        const GridSize size = sized(each);
        NaiveGrid start(rules, size);
        for (int run = 0; run < 4 && start.propagate(); ++run) {
            ASSERT_TRUE(run_succeeds(start, size, random)) << "seed " << seed;
        }
    }
}

}  // namespace modelsynth::testing
