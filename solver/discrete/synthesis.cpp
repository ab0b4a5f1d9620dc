#include "solver/discrete/synthesis.h"

#include "solver/core/block_schedule.h"
#include "solver/discrete/initial_model.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace modelsynth::discrete {

namespace {

Error cancelled() { return {ErrorCode::kCancelled, "the synthesis was stopped", {}}; }

// One run; the state that its steps share.
class Run {
  public:
    Run(Preparation& preparation,
        std::uint64_t seed,
        Observer& observer,
        const std::stop_token& stop)
        : preparation_(preparation),
          problem_(preparation.problem()),
          seed_(seed),
          observer_(observer),
          stop_(stop),
          search_(preparation.take_search()) {}

    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    ~Run() { preparation_.give_back(std::move(search_)); }

    Result<Synthesis> in_blocks(const Blocks& blocks, const Checkpoint* from) {
        auto schedule = schedule_blocks(problem_.size, blocks.layout, kBlockCountMax);
        if (!schedule) {
            return tl::unexpected(std::move(schedule.error()));
        }
        Result<InitialModel> found;
        if (!preparation_.plain_model()) {
            found = find_initial_model(
                preparation_.example(),
                problem_,
                *search_,
                !preparation_.is_plain_model_rigid(),
                seed_,
                stop_
            );
            if (!found) {
                return tl::unexpected(std::move(found.error()));
            }
        }
        const std::vector<Label>& initial =
            preparation_.plain_model() ? *preparation_.plain_model() : found->labels;
        labels_ = initial;
        if (from != nullptr) {
            go_on_from(*from, schedule->size());
        }
        blocks_total_ = static_cast<std::uint32_t>(schedule->size());
        observer_.on_start(blocks_total_, labels_);
        for (const Box& block : std::span(*schedule).subspan(block_index_)) {
            const BlockResult result = modify(block, blocks.attempts);
            if (result.outcome == BlockOutcome::kStopped) {
                return tl::unexpected(cancelled());
            }
            check(
                result.outcome != BlockOutcome::kImpossible,
                "a block of a consistent model was found impossible"
            );
            report(block, result);
        }
        if (found->is_searched) {
            return finish(1);
        }
        std::size_t changed = 0;
        for (std::size_t site = 0; site < labels_.size(); ++site) {
            changed += std::size_t{labels_[site] != initial[site]};
        }
        return finish(static_cast<double>(changed) / static_cast<double>(labels_.size()));
    }

    Result<Synthesis> at_once(const Checkpoint* from) {
        labels_.assign(problem_.size.cell_count(), kNoLabel);
        blocks_total_ = 1;
        if (from != nullptr && from->tally.accepted() > 0) {
            go_on_from(*from, blocks_total_);
            observer_.on_start(blocks_total_, labels_);
            return finish(1);
        }
        observer_.on_start(blocks_total_, {});
        const Box whole = Box::whole(problem_.size);
        const BlockResult result = modify(whole, kWholeAttempts);
        switch (result.outcome) {
            case BlockOutcome::kAccepted:
                report(whole, result);
                return finish(1);
            case BlockOutcome::kStopped:
                return tl::unexpected(cancelled());
            case BlockOutcome::kImpossible:
                return tl::unexpected(contradiction_at(
                    preparation_.example(), problem_, problem_.size.cell(result.impossible_site)
                ));
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
                from.tally.accepted() + from.tally.reverted == from.blocks_done,
            "a checkpoint of another synthesis"
        );
        labels_ = from.labels;
        block_index_ = from.blocks_done;
        stats_.blocks = from.tally;
    }

    BlockResult modify(const Box& block, std::uint32_t attempts) {
        if (stop_.stop_requested()) {
            return {BlockOutcome::kStopped};
        }
        const GridPart part(problem_.size, problem_.periodic, block);
        const GridSize shape = block.size();
        if (shape != scan_shape_) {
            scan_ = column_order(shape);
            scan_shape_ = shape;
        }
        return search_->modify(
            part,
            std::span<Label>(labels_),
            {attempts, preparation_.parameters().order, scan_},
            {seed_, block_index_, 0, 0},
            stop_
        );
    }

    void report(const Box& block, const BlockResult& result) {
        const bool accepted = result.outcome == BlockOutcome::kAccepted;
        SearchTally& tally = stats_.blocks;
        ++(accepted ? tally.solved_by[static_cast<std::size_t>(result.solved_by)] : tally.reverted);
        tally.backtracks += result.backtracks;
        observer_.on_block(
            {block_index_, blocks_total_, block, accepted, result.attempts, tally, labels_}
        );
        ++block_index_;
    }

    Synthesis finish(double changed) {
        stats_.changed = changed;
        return {problem_.size, std::move(labels_), stats_};
    }

    Preparation& preparation_;
    const Problem& problem_;
    std::uint64_t seed_;
    Observer& observer_;
    const std::stop_token& stop_;
    std::unique_ptr<Preparation::Search> search_;
    std::vector<Label> labels_;
    std::vector<Site> scan_;
    GridSize scan_shape_;
    std::uint32_t block_index_ = 0;
    std::uint32_t blocks_total_ = 0;
    SynthesisStats stats_;
};

}  // namespace

Result<Synthesis> synthesise(
    Preparation& preparation,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from
) {
    const auto& blocks = *preparation.parameters().blocks;
    Run run(preparation, seed, observer, stop);
    return blocks ? run.in_blocks(*blocks, from) : run.at_once(from);
}

Result<Synthesis> synthesise(
    const Example& example,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from
) {
    const std::shared_ptr<const Example> not_owned(std::shared_ptr<const Example>(), &example);
    const auto preparation = Preparation::make(not_owned, parameters);
    if (!preparation) {
        return tl::unexpected(preparation.error());
    }
    return synthesise(**preparation, seed, observer, stop, from);
}

}  // namespace modelsynth::discrete
