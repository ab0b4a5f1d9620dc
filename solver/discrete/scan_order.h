#pragma once

#include "solver/core/grid.h"
#include "solver/core/topology.h"

#include <vector>

namespace modelsynth::discrete {

// The sites of a grid column by column, each from the bottom up: the order of Algorithm 3.1.
[[nodiscard]] std::vector<Site> column_order(const GridSize& size);

}  // namespace modelsynth::discrete
