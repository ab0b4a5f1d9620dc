#include "solver/discrete/block_solver.h"

#include "solver/discrete/constraint_reader.h"

#include <utility>

namespace modelsynth::discrete {

BlockSolver::BlockSolver(Preparation& preparation, std::uint64_t seed, std::stop_token stop)
    : preparation_(preparation),
      seed_(seed),
      stop_(std::move(stop)),
      search_(preparation.take_search()) {}

BlockSolver::~BlockSolver() { preparation_.give_back(std::move(search_)); }

void BlockSolver::begin(std::span<const Label> labels) {
    const Problem& problem = preparation_.problem();
    if (!problem.member_rules.empty()) {
        board_ = make_board(problem, problem.member_rules);
        board_->start(labels);
    }
}

BlockResult BlockSolver::modify(
    std::span<Label> labels, const Box& block, std::uint32_t index, std::uint32_t attempts
) {
    if (stop_.stop_requested()) {
        return {BlockOutcome::kStopped};
    }
    return search_->modify(
        block,
        labels,
        {attempts,
         preparation_.parameters().order,
         board_.get(),
         std::nullopt,
         preparation_.problem().chooser.get()},
        {seed_, index, 0, 0},
        stop_
    );
}

void BlockSolver::take_back(std::span<const Label> labels, const Box& block) {
    if (board_ != nullptr) {
        search_->note_change(block, labels, *board_);
    }
}

}  // namespace modelsynth::discrete
