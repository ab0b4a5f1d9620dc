#include "solver/discrete/block_solver.h"

#include "solver/discrete/constraint_reader.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

constexpr std::uint32_t kAttemptsInstead = 2;  // by either order

// A formula and a proof that take tenths of a second at most.
constexpr SatLimits kBlockBySat = {1'000'000, 2'000};

// RandomKey::block of the searches made in a block's place: its index and so many times
// kWhichStep.
constexpr std::uint32_t kWhichStep = 1U << 20;
constexpr std::uint32_t kErodedBorder = 1;
constexpr std::uint32_t kFirstPart = 2;

// How far the border erodes.
constexpr std::int32_t kErosion = 2;

Box grown(const Box& block, const GridSize& model) {
    return {
        {std::max(0, block.min.x - kErosion),
         std::max(0, block.min.y - kErosion),
         std::max(0, block.min.z - kErosion)},
        {std::min(model.x, block.max.x + kErosion),
         std::min(model.y, block.max.y + kErosion),
         std::min(model.z, block.max.z + kErosion)}};
}

}  // namespace

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

BlockResult BlockSolver::attempt(
    std::span<Label> labels,
    const Box& block,
    std::uint32_t index,
    std::uint32_t attempts,
    std::span<std::uint32_t> dead_ends
) {
    if (stop_.stop_requested()) {
        return {BlockOutcome::kStopped};
    }
    BoxOptions options = {attempts, preparation_.order(), board_.get()};
    options.chooser = preparation_.problem().chooser.get();
    options.dead_ends = dead_ends;
    options.usual = usual_;
    return search_->modify(block, labels, options, {seed_, index, 0, 0}, stop_);
}

ModifiedBlock BlockSolver::modify(
    std::span<Label> labels, const Box& block, std::uint32_t index, std::uint32_t attempts
) {
    ModifiedBlock modified = {attempt(labels, block, index, attempts), search_->touched(block)};
    BlockResult& result = modified.result;
    if (result.outcome != BlockOutcome::kReverted || modify_parts(labels, block, index, result)) {
        return modified;
    }
    const Box eroded = grown(block, preparation_.problem().size);
    const BlockResult larger = attempt_instead(labels, eroded, index, kErodedBorder);
    result.backtracks += larger.backtracks;
    if (larger.outcome == BlockOutcome::kAccepted) {
        result.outcome = larger.outcome;
        result.solved_by = SolvedBy::kErodedBorder;
        modified.changed = search_->touched(eroded);
        return modified;
    }
    if (larger.outcome == BlockOutcome::kReverted && board_ == nullptr) {
        BoxOptions options = {0, preparation_.order()};
        options.by_sat = kBlockBySat;
        const auto by_sat = search_->modify(block, labels, options, {seed_, index, 0, 0}, stop_);
        result.outcome = by_sat.outcome;
        result.solved_by = by_sat.solved_by;
    } else {
        result.outcome = larger.outcome;
    }
    return modified;
}

Box BlockSolver::reach(const Box& block) const {
    return search_->touched(grown(block, preparation_.problem().size));
}

BlockResult BlockSolver::attempt_instead(
    std::span<Label> labels, const Box& box, std::uint32_t index, std::uint32_t which
) {
    static_assert(kBlockCountMax <= kWhichStep);
    return attempt(labels, box, index + which * kWhichStep, kAttemptsInstead);
}

// True when that is the end of the block.
bool BlockSolver::modify_parts(
    std::span<Label> labels, const Box& block, std::uint32_t index, BlockResult& result
) {
    bool any = false;
    std::uint32_t which = kFirstPart;
    for (const Box& part : corners_of(block)) {
        const BlockResult smaller = attempt_instead(labels, part, index, which++);
        result.backtracks += smaller.backtracks;
        any = any || smaller.outcome == BlockOutcome::kAccepted;
        if (smaller.outcome == BlockOutcome::kStopped) {
            result.outcome = BlockOutcome::kStopped;
            return true;
        }
    }
    if (any) {
        result.outcome = BlockOutcome::kAccepted;
        result.solved_by = SolvedBy::kSmallerBlock;
    }
    return any;
}

void BlockSolver::take_back(std::span<const Label> labels, const Box& block) {
    if (board_ != nullptr) {
        search_->note_change(block, labels, *board_);
    }
}

}  // namespace modelsynth::discrete
