#pragma once

#include "solver/core/block_search.h"
#include "solver/core/constraints/constraint_board.h"
#include "solver/discrete/box_search.h"
#include "solver/discrete/preparation.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

namespace modelsynth::discrete {

// More blocks than this are refused.
inline constexpr std::size_t kBlockCountMax = 1'000'000;

// What became of a block.
struct ModifiedBlock {
    BlockResult result;
    Box changed;  // holds all cells that may have new labels
};

// Modifies the blocks of one run; one per thread.
//
// A block that every attempt fails at is not given up at once: the search then makes smaller parts
// of it, which need not fit each other; then it lets the border erode, so that what stands around
// the block changes with it as long as all beyond stays consistent (as POMS does,
// github.com/zzyzek/PunchOutModelSynthesis); then CaDiCaL is asked for the block as it was.
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

    // The model before the first block, see BlockOptions::usual.
    // Requires: it outlives the solver or the next call.
    void expect(std::span<const Label> usual) { usual_ = usual; }

    // As BoxSearch::modify(), under the member rules once begin() was called: attempts alone.
    [[nodiscard]] BlockResult attempt(
        std::span<Label> labels,
        const Box& block,
        std::uint32_t index,
        std::uint32_t attempts,
        std::span<std::uint32_t> dead_ends = {}
    );

    // Everything above.
    // Requires: the model is consistent; index is below kBlockCountMax.
    [[nodiscard]] ModifiedBlock modify(
        std::span<Label> labels, const Box& block, std::uint32_t index, std::uint32_t attempts
    );

    // Holds all that modify() may change.
    [[nodiscard]] Box reach(const Box& block) const;

    // The block has other labels again than modify() left.
    void take_back(std::span<const Label> labels, const Box& block);

  private:
    // A search of another box than the block itself, with its own random numbers.
    BlockResult attempt_instead(
        std::span<Label> labels, const Box& box, std::uint32_t index, std::uint32_t which
    );
    bool modify_parts(
        std::span<Label> labels, const Box& block, std::uint32_t index, BlockResult& result
    );

    Preparation& preparation_;
    std::uint64_t seed_;
    std::stop_token stop_;
    std::span<const Label> usual_;
    std::unique_ptr<BoxSearch> search_;
    std::unique_ptr<ConstraintBoard> board_;  // null: the problem has no member rules
};

}  // namespace modelsynth::discrete
