#include "solver/discrete/synthesis.h"

#include "solver/core/block_schedule.h"
#include "solver/core/block_search.h"
#include "solver/discrete/initial_model.h"
#include "solver/discrete/problem.h"

#include <span>
#include <string>
#include <utility>

namespace modelsynth::discrete {

namespace {

Error cancelled() { return {ErrorCode::kCancelled, "the synthesis was stopped", {}}; }

// One run; the state that its steps share.
class Run {
  public:
    Run(const Example& example,
        const Parameters& parameters,
        const Problem& problem,
        std::uint64_t seed,
        Observer& observer,
        const std::stop_token& stop)
        : example_(example),
          parameters_(parameters),
          problem_(problem),
          seed_(seed),
          observer_(observer),
          stop_(stop) {}

    Result<Synthesis> in_blocks(const Blocks& blocks, const Checkpoint* from) {
        auto schedule = schedule_blocks(problem_.size, blocks.layout, kBlockCountMax);
        if (!schedule) {
            return tl::unexpected(std::move(schedule.error()));
        }
        auto initial = find_initial_model(example_, problem_, seed_, stop_);
        if (!initial) {
            return tl::unexpected(std::move(initial.error()));
        }
        labels_ = *initial;
        if (from != nullptr) {
            go_on_from(*from, schedule->size());
        }
        blocks_total_ = static_cast<std::uint32_t>(schedule->size());
        BlockBases<GridTopology> bases;
        observer_.on_start(blocks_total_, labels_);
        for (const Box& block : std::span(*schedule).subspan(block_index_)) {
            const BlockResult result = modify(block, blocks.attempts, &bases);
            if (result.outcome == BlockOutcome::kStopped) {
                return tl::unexpected(cancelled());
            }
            check(
                result.outcome != BlockOutcome::kImpossible,
                "a block of a consistent model was found impossible"
            );
            report(block, result);
        }
        std::size_t changed = 0;
        for (std::size_t site = 0; site < labels_.size(); ++site) {
            changed += std::size_t{labels_[site] != (*initial)[site]};
        }
        return finish(static_cast<double>(changed) / static_cast<double>(labels_.size()));
    }

    Result<Synthesis> at_once(const Checkpoint* from) {
        labels_.assign(problem_.size.cell_count(), kNoLabel);
        blocks_total_ = 1;
        if (from != nullptr && from->blocks_accepted > 0) {
            go_on_from(*from, blocks_total_);
            observer_.on_start(blocks_total_, labels_);
            return finish(1);
        }
        observer_.on_start(blocks_total_, {});
        const Box whole = Box::whole(problem_.size);
        const BlockResult result = modify(whole, kWholeAttempts, nullptr);
        switch (result.outcome) {
            case BlockOutcome::kAccepted:
                report(whole, result);
                return finish(1);
            case BlockOutcome::kStopped:
                return tl::unexpected(cancelled());
            case BlockOutcome::kImpossible:
                return tl::unexpected(
                    contradiction_at(example_, problem_, problem_.size.cell(result.impossible_site))
                );
            case BlockOutcome::kReverted:
                break;
        }
        return tl::unexpected(Error{
            ErrorCode::kGaveUp,
            "no model was found in " + std::to_string(kWholeAttempts) +
                " attempts at the whole at once; blocks succeed more often",
            {}});
    }

  private:
    void go_on_from(const Checkpoint& from, std::size_t blocks_total) {
        check(
            from.labels.size() == labels_.size() && from.blocks_done <= blocks_total &&
                from.blocks_accepted <= from.blocks_done,
            "a checkpoint of another synthesis"
        );
        labels_ = from.labels;
        block_index_ = from.blocks_done;
        stats_.blocks_accepted = from.blocks_accepted;
        stats_.blocks_reverted = from.blocks_done - from.blocks_accepted;
    }

    BlockResult modify(const Box& block, std::uint32_t attempts, BlockBases<GridTopology>* bases) {
        if (stop_.stop_requested()) {
            return {BlockOutcome::kStopped, 0, 0};
        }
        const GridPart part(problem_.size, problem_.periodic, block);
        const GridSize shape = block.size();
        if (shape != scan_shape_) {
            scan_ = column_order(shape);
            scan_shape_ = shape;
        }
        return modify_block(
            part,
            problem_.relations,
            problem_.domains,
            problem_.weights,
            std::span<Label>(labels_),
            {attempts, parameters_.order, scan_},
            {seed_, block_index_, 0, 0},
            stop_,
            bases
        );
    }

    void report(const Box& block, const BlockResult& result) {
        const bool accepted = result.outcome == BlockOutcome::kAccepted;
        ++(accepted ? stats_.blocks_accepted : stats_.blocks_reverted);
        observer_.on_block(
            {block_index_,
             blocks_total_,
             block,
             accepted,
             result.attempts,
             stats_.blocks_accepted,
             labels_}
        );
        ++block_index_;
    }

    Synthesis finish(double changed) {
        stats_.changed = changed;
        return {problem_.size, std::move(labels_), stats_};
    }

    const Example& example_;
    const Parameters& parameters_;
    const Problem& problem_;
    std::uint64_t seed_;
    Observer& observer_;
    const std::stop_token& stop_;
    std::vector<Label> labels_;
    std::vector<Site> scan_;
    GridSize scan_shape_;
    std::uint32_t block_index_ = 0;
    std::uint32_t blocks_total_ = 0;
    SynthesisStats stats_;
};

}  // namespace

Result<Synthesis> synthesise(
    const Example& example,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from
) {
    auto problem = make_problem(example, parameters);
    if (!problem) {
        return tl::unexpected(std::move(problem.error()));
    }
    Run run(example, parameters, *problem, seed, observer, stop);
    return *parameters.blocks ? run.in_blocks(**parameters.blocks, from) : run.at_once(from);
}

}  // namespace modelsynth::discrete
