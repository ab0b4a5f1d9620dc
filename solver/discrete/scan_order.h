#pragma once

#include "solver/core/grid.h"
#include "solver/core/topology.h"

#include <array>
#include <cstdint>
#include <vector>

namespace modelsynth::discrete {

// The axes of a scan, 0 x, 1 y, 2 z, from the slowest to the fastest.
using ScanAxes = std::array<std::uint8_t, 3>;

// Column by column, each from the bottom up: the order of Algorithm 3.1.
inline constexpr ScanAxes kColumns = {0, 2, 1};

// The sites of a grid, along each axis from the lowest up. Requires: each axis once (checked).
[[nodiscard]] std::vector<Site> scan_order(const GridSize& size, const ScanAxes& axes);

[[nodiscard]] inline std::vector<Site> column_order(const GridSize& size) {
    return scan_order(size, kColumns);
}

}  // namespace modelsynth::discrete
