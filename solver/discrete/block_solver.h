#pragma once

#include "solver/core/block_search.h"
#include "solver/core/constraints/constraint_board.h"
#include "solver/discrete/box_search.h"
#include "solver/discrete/preparation.h"

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

namespace modelsynth::discrete {

// Modifies the blocks of one run; one per thread.
// Requires: the preparation outlives it.
class BlockSolver {
  public:
    BlockSolver(Preparation& preparation, std::uint64_t seed, std::stop_token stop);
    ~BlockSolver();

    BlockSolver(const BlockSolver&) = delete;
    BlockSolver& operator=(const BlockSolver&) = delete;

    [[nodiscard]] BoxSearch& search() { return *search_; }

    // The model stands as it is from now on, but for what modify() makes of it; it satisfies the
    // member rules where it is complete.
    void begin(std::span<const Label> labels);

    // As BoxSearch::modify(), under the member rules once begin() was called.
    [[nodiscard]] BlockResult modify(
        std::span<Label> labels, const Box& block, std::uint32_t index, std::uint32_t attempts
    );

    // The block has other labels again than modify() left.
    void take_back(std::span<const Label> labels, const Box& block);

  private:
    Preparation& preparation_;
    std::uint64_t seed_;
    std::stop_token stop_;
    std::unique_ptr<BoxSearch> search_;
    std::unique_ptr<ConstraintBoard> board_;  // null: the problem has no member rules
};

}  // namespace modelsynth::discrete
