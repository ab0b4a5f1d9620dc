// BlockSearch on graphs, compiled once for all who use it.

#include "solver/core/block_search.h"

namespace modelsynth {

template class BlockSearch<GraphPart>;

}  // namespace modelsynth
