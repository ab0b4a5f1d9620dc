#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/example.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace modelsynth::testing {

// Arc consistency and exhaustive search over tiny grids, written for plainness with none of the
// solver's code, for at most 32 labels. Labels of weight 0 are not looked at.
struct NaiveRules {
    explicit NaiveRules(const discrete::Example& example) {
        const GridSize& size = example.size;
        for (int y = 0; y < size.y; ++y) {
            for (int z = 0; z < size.z; ++z) {
                for (int x = 0; x < size.x; ++x) {
                    const auto at = [&](int i, int j, int k) {
                        return example
                            .cells[static_cast<std::size_t>(i + size.x * (k + size.z * j))];
                    };
                    const Label here = at(x, y, z);
                    usable |= 1U << here;
                    if (x + 1 < size.x) {
                        allow(0, here, at(x + 1, y, z));
                    }
                    if (y + 1 < size.y) {
                        allow(1, here, at(x, y + 1, z));
                    }
                    if (z + 1 < size.z) {
                        allow(2, here, at(x, y, z + 1));
                    }
                }
            }
        }
        for (const auto& pair : example.adjacency) {
            allow(pair.axis, pair.lower, pair.upper);
        }
    }

    void allow(std::size_t axis, Label lower, Label upper) {
        after.at(axis).at(lower) |= 1U << upper;
        before.at(axis).at(upper) |= 1U << lower;
        usable |= 1U << lower | 1U << upper;
    }

    [[nodiscard]] bool is_open(std::size_t axis) const {
        return std::any_of(after[axis].begin(), after[axis].end(), [](auto set) {
            return set != 0;
        });
    }

    std::uint32_t usable = 0;
    std::array<std::array<std::uint32_t, 32>, 3> after = {};   // [axis][label]: what may follow it
    std::array<std::array<std::uint32_t, 32>, 3> before = {};  // and what may come before it
};

class NaiveGrid {
  public:
    NaiveGrid(const NaiveRules& rules, const GridSize& size)
        : rules_(&rules), size_(size), cells_(size.cell_count(), rules.usable) {}

    [[nodiscard]] std::uint32_t& at(const Cell& cell) { return cells_[index(cell)]; }

    // Sweeps until nothing changes; false when a cell has nothing left.
    bool propagate() {
        for (bool changed = true; changed;) {
            changed = false;
            for (int y = 0; y < size_.y; ++y) {
                for (int z = 0; z < size_.z; ++z) {
                    for (int x = 0; x < size_.x; ++x) {
                        changed = look({x, y, z}, 0, {x + 1, y, z}) || changed;
                        changed = look({x, y, z}, 1, {x, y + 1, z}) || changed;
                        changed = look({x, y, z}, 2, {x, y, z + 1}) || changed;
                    }
                }
            }
        }
        return std::find(cells_.begin(), cells_.end(), 0U) == cells_.end();
    }

    // How many ways there are to go on, at most `most` of them.
    [[nodiscard]] std::uint64_t count_completions(std::uint64_t most) const {
        NaiveGrid grid = *this;
        if (!grid.propagate()) {
            return 0;
        }
        // The cell with the fewest labels of those with several.
        const auto open = std::min_element(
            grid.cells_.begin(),
            grid.cells_.end(),
            [](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); }
        );
        if (rank(*open) == rank(1)) {
            return 1;
        }
        std::uint64_t count = 0;
        const std::uint32_t set = *open;
        for (std::uint32_t bit = 1; bit != 0 && bit <= set && count < most; bit <<= 1) {
            if ((set & bit) != 0) {
                *open = bit;
                count += grid.count_completions(most - count);
            }
        }
        return count;
    }

    [[nodiscard]] bool has_completion() const { return count_completions(1) > 0; }

  private:
    // Sets by size, those of one label last.
    static int rank(std::uint32_t set) {
        const int count = std::popcount(set);
        return count > 1 ? count : 33;
    }

    [[nodiscard]] std::size_t index(const Cell& cell) const {
        return static_cast<std::size_t>(cell.x + size_.x * (cell.z + size_.z * cell.y));
    }

    static std::uint32_t joined(const std::array<std::uint32_t, 32>& rows, std::uint32_t set) {
        std::uint32_t all = 0;
        for (; set != 0; set &= set - 1) {
            all |= rows[static_cast<std::size_t>(std::countr_zero(set))];
        }
        return all;
    }

    bool look(const Cell& lower, std::size_t axis, const Cell& upper) {
        if (upper.x >= size_.x || upper.y >= size_.y || upper.z >= size_.z) {
            return false;
        }
        std::uint32_t& a = cells_[index(lower)];
        std::uint32_t& b = cells_[index(upper)];
        const std::uint32_t old_a = a;
        const std::uint32_t old_b = b;
        b &= joined(rules_->after[axis], a);
        a &= joined(rules_->before[axis], b);
        return a != old_a || b != old_b;
    }

    const NaiveRules* rules_;
    GridSize size_;
    std::vector<std::uint32_t> cells_;  // bit l: label l is possible
};

}  // namespace modelsynth::testing
