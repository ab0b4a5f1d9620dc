#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/block_solver.h"
#include "solver/discrete/preparation.h"

#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

namespace modelsynth::discrete {

struct BlocksToModify {
    std::span<const Box> schedule;
    std::uint32_t first = 0;  // those before it are done
    std::uint32_t attempts = 1;
    std::uint32_t threads = 2;
    std::span<const Label> usual = {};  // as of BlockSolver::expect()
};

// Modifies blocks that do not meet at the same time, in a copy of the model that is ahead of what
// was reported. `report` is called on this thread, in the order of the schedule, when the model has
// the block's labels; nothing that it sees depends on the number of threads.
// Requires: the problem has nothing that makes a block depend on all before it.
// False:    `stop` was requested before the last block.
[[nodiscard]] bool modify_in_parallel(
    Preparation& preparation,
    BlockSolver& own,
    std::uint64_t seed,
    const BlocksToModify& blocks,
    std::span<Label> model,
    const std::stop_token& stop,
    const std::function<void(const ModifiedBlock&)>& report
);

}  // namespace modelsynth::discrete
