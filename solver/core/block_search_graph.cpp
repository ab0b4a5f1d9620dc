// BlockSearch on graphs, compiled once for all who use it.

#include "solver/core/block_search_of_width.h"

namespace modelsynth {

template class BlockSearch<GraphPart>;

}  // namespace modelsynth
