#include "solver/discrete/explanation/contradiction.h"

#include <algorithm>
#include <numeric>

namespace modelsynth::discrete {

DeadEnds hottest_of(const GridSize& size, std::span<const std::uint32_t> counts) {
    constexpr std::size_t kMost = 8;
    std::vector<std::size_t> cells(counts.size());
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    const std::size_t most = std::min(kMost, cells.size());
    const auto middle = cells.begin() + static_cast<std::ptrdiff_t>(most);
    std::partial_sort(cells.begin(), middle, cells.end(), [&](std::size_t a, std::size_t b) {
        return counts[a] != counts[b] ? counts[a] > counts[b] : a < b;
    });
    DeadEnds dead_ends;
    for (std::size_t i = 0; i < most && counts[cells[i]] > 0; ++i) {
        dead_ends.hottest.push_back({size.cell(cells[i]), counts[cells[i]]});
    }
    return dead_ends;
}

}  // namespace modelsynth::discrete
