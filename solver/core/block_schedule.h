#pragma once

#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"
#include "solver/core/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// How a grid is cut into overlapping blocks (Algorithms 3.4 and 3.5).
struct BlockLayout {
    GridSize size = {10, 10, 10};  // cells; a block larger than the model is cut to it
    double overlap = 0.5;          // share of a block that its successor covers again, [0, 1)
    std::uint32_t passes = 1;      // how often the whole schedule is run

    friend bool operator==(const BlockLayout&, const BlockLayout&) = default;
};

// Blocks of Algorithm 3.4 and how often each is tried before it is taken back.
struct Blocks {
    BlockLayout layout;
    std::uint32_t attempts = 8;

    friend bool operator==(const Blocks&, const Blocks&) = default;
};

// The blocks in the order in which they are modified: x outermost, then z, then y (the thesis's
// q_x, q_y, q_z, whose third axis points up). They cover every cell; the last block of an axis is
// moved back so that it ends with the model.
// Fails: kTooLarge when there would be more than block_count_max.
[[nodiscard]] Result<std::vector<Box>> schedule_blocks(
    const GridSize& model, const BlockLayout& layout, std::size_t block_count_max
);

// What may succeed where a block does not: its four corners, seen from above, each as high and
// three fifths as wide and deep. They overlap, so that no seam is left that nothing may cross.
// Those that are the whole block are left out.
[[nodiscard]] std::vector<Box> corners_of(const Box& block);

// Whether two blocks overlap or touch, also across the seam of a periodic axis. A block changes its
// cells and reads those that touch them: of two blocks that meet, the later one has to wait for the
// earlier; others may be modified at the same time, and all comes out as if they were modified one
// after the other.
[[nodiscard]] bool blocks_meet(
    const Box& a, const Box& b, const GridSize& model, Periodic periodic
);

}  // namespace modelsynth
