#include "solver/discrete/parallel_blocks.h"

#include "solver/core/parallel_blocks.h"
#include "solver/discrete/box_labels.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

struct Solved {
    ModifiedBlock block;
    std::vector<Label> labels;  // of the box that changed, when it was accepted
};

}  // namespace

bool modify_in_parallel(
    Preparation& preparation,
    BlockSolver& own,
    std::uint64_t seed,
    const BlocksToModify& blocks,
    std::span<Label> model,
    const std::stop_token& stop,
    const std::function<void(const ModifiedBlock&)>& report
) {
    const GridSize size = preparation.problem().size;
    std::vector<Box> reaches;  // what each block may change
    reaches.reserve(blocks.schedule.size());
    for (const Box& block : blocks.schedule) {
        reaches.push_back(own.reach(block));
    }
    std::vector<Label> ahead(model.begin(), model.end());
    const auto solve = [&](BlockSolver& solver, std::uint32_t block) -> std::optional<Solved> {
        Solved solved = {solver.modify(ahead, blocks.schedule[block], block, blocks.attempts), {}};
        if (solved.block.result.outcome == BlockOutcome::kStopped) {
            return std::nullopt;
        }
        if (solved.block.result.outcome == BlockOutcome::kAccepted) {
            copy_out(size, ahead, solved.block.changed, solved.labels);
        }
        return solved;
    };
    using Parallel = ParallelBlocks<Solved>;
    return Parallel(size, preparation.problem().periodic, reaches, blocks.first)
        .run(
            blocks.threads,
            [&](std::uint32_t block) { return solve(own, block); },
            [&]() -> Parallel::Solver {
                auto solver = std::make_shared<BlockSolver>(preparation, seed, stop);
                solver->expect(blocks.usual);
                return [&solve, solver](std::uint32_t block) { return solve(*solver, block); };
            },
            [&](std::uint32_t /*block*/, const Solved& solved) {
                if (solved.block.result.outcome == BlockOutcome::kAccepted) {
                    copy_in(size, solved.labels, solved.block.changed, model);
                }
                report(solved.block);
            }
        );
}

}  // namespace modelsynth::discrete
