#pragma once

#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/symmetry/symmetries.h"
#include "solver/core/graph_topology.h"

#include <vector>

namespace modelsynth::continuous {

// Vertices of an arrangement as a part to be made anew, with their images where there are
// symmetries. Requires: in rising order, each once.
[[nodiscard]] GraphPart part_of(
    const Arrangement& arrangement, std::vector<Site> vertices, const Symmetries* symmetries
);

}  // namespace modelsynth::continuous
