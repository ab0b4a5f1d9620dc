#include "solver/continuous/synthesis.h"

#include "solver/core/block_schedule.h"
#include "solver/core/block_search.h"

#include <span>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr std::size_t kBlockCountMax = 1'000'000;
constexpr std::uint32_t kWholeAttempts = 8;

Error cancelled() { return {ErrorCode::kCancelled, "the synthesis was stopped", {}}; }

double changed_from(std::span<const Label> initial, std::span<const Label> labels) {
    std::size_t changed = 0;
    for (std::size_t site = 0; site < labels.size(); ++site) {
        changed += std::size_t{labels[site] != initial[site]};
    }
    return labels.empty() ? 0 : static_cast<double>(changed) / static_cast<double>(labels.size());
}

}  // namespace

Result<Synthesis> synthesise(
    const Problem& problem,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from
) {
    const GridSize& cells = problem.arrangement.frame().cells;
    const std::optional<Blocks>& blocks = *parameters.blocks;
    std::vector<Box> schedule = {Box::whole(cells)};
    if (blocks) {
        auto cut = schedule_blocks(cells, blocks->layout, kBlockCountMax);
        if (!cut) {
            return tl::unexpected(std::move(cut.error()));
        }
        schedule = std::move(*cut);
    }
    Synthesis made = {problem.initial, {}};
    std::uint32_t index = 0;
    if (from != nullptr) {
        check(
            from->labels.size() == made.labels.size() && from->blocks_done <= schedule.size(),
            "a checkpoint of another synthesis"
        );
        made.labels = from->labels;
        made.stats.blocks = from->tally;
        index = from->blocks_done;
    }
    const auto total = static_cast<std::uint32_t>(schedule.size());
    observer.on_start(total, made.labels);
    BlockBases<GraphTopology> bases;
    BlockSearch<GraphPart> search(
        problem.reading->relations(), problem.domains, problem.weights, &bases
    );
    const std::uint32_t attempts = blocks ? blocks->attempts : kWholeAttempts;
    for (; index < total; ++index) {
        if (stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        const GraphPart part = part_of(problem.arrangement, schedule[index]);
        const BlockResult result = search.modify(
            part, made.labels, {attempts, Order::kRandom, {}}, {seed, index, 0, 0}, stop
        );
        if (result.outcome == BlockOutcome::kStopped) {
            return tl::unexpected(cancelled());
        }
        check(
            result.outcome != BlockOutcome::kImpossible,
            "a block of a consistent model was found impossible"
        );
        const bool accepted = result.outcome == BlockOutcome::kAccepted;
        SearchTally& tally = made.stats.blocks;
        ++(accepted ? tally.solved_by[static_cast<std::size_t>(result.solved_by)] : tally.reverted);
        tally.backtracks += result.backtracks;
        observer.on_block(
            {index, total, schedule[index], accepted, result.attempts, tally, made.labels}
        );
    }
    if (!blocks && made.stats.blocks.accepted() == 0) {
        return tl::unexpected(Error{
            ErrorCode::kGaveUp,
            "no model was found in " + std::to_string(kWholeAttempts) +
                " attempts at the whole at once; blocks succeed more often",
            {}});
    }
    made.stats.changed = changed_from(problem.initial, made.labels);
    return made;
}

}  // namespace modelsynth::continuous
