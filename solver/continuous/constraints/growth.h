#pragma once

#include "solver/continuous/constraints/connections.h"
#include "solver/continuous/planes/skeleton.h"
#include "solver/continuous/problem.h"
#include "solver/core/block_search.h"
#include "solver/core/graph_topology.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

// What is to hang together grows from one place (thesis 4.6.2): nothing of it begins by itself, and
// no block is taken that would have it in more components than it may be.
// Thread-safety: one thread at a time, block after block.
class Growth {
  public:
    // Requires: the problem outlives it, and has connections.
    explicit Growth(const Problem& problem);

    // The model stands.
    void start(std::span<const Label> model) { connections_.start(model); }

    // The part is about to be made anew, as the options will have it.
    void enter(const GraphPart& part, BlockOptions& options);

    // After that: the part with something in it of the first connection of which there is nothing
    // elsewhere, or less than there may be: the largest of some tries, since what happens to close
    // early stays small. kReverted where there is no such connection, or nothing of it fits.
    // `blocks_left`: with this one.
    BlockResult begin_something(
        BlockSearch<GraphPart>& search,
        const GraphPart& part,
        std::vector<Label>& labels,
        BlockOptions options,
        const RandomKey& key,
        std::uint32_t blocks_left,
        const std::stop_token& stop
    );

    // Why the model is none, when it is none: what was fixed apart was not brought together.
    [[nodiscard]] std::optional<Error> find_fault() const;

  private:
    [[nodiscard]] bool is_beginning_due(
        std::size_t connection, std::uint32_t blocks_left, RandomStream& random
    ) const;
    void put(const GraphPart& part, std::span<const Label> before, std::vector<Label>& labels);

    const Problem& problem_;
    std::vector<LabelSet> growing_;   // by connection
    std::vector<std::size_t> order_;  // of connections, in which they are begun
    Skeleton skeleton_;
    Connections connections_;
};

}  // namespace modelsynth::continuous
