#pragma once

#include "solver/continuous/arrangement.h"
#include "solver/core/graph_topology.h"

#include <vector>

namespace modelsynth::continuous {

// Vertices of an arrangement as a part to be made anew. Requires: in rising order, each once.
[[nodiscard]] GraphPart part_of(const Arrangement& arrangement, std::vector<Site> vertices);

// Those of a box of cells.
[[nodiscard]] GraphPart part_of(const Arrangement& arrangement, const Box& cells);

}  // namespace modelsynth::continuous
