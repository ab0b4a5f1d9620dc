// BlockSearch on grids, compiled once for all who use it.

#include "solver/core/block_search.h"

namespace modelsynth {

template class BlockSearch<GridPart>;

}  // namespace modelsynth
