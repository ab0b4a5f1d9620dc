#include "solver/discrete/synthesis.h"

#include "solver/core/block_schedule.h"
#include "solver/discrete/best_of.h"
#include "solver/discrete/block_solver.h"
#include "solver/discrete/box_labels.h"
#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/explanation/contradiction.h"
#include "solver/discrete/explanation/explain.h"
#include "solver/discrete/initial_model.h"
#include "solver/discrete/objective.h"
#include "solver/discrete/parallel_blocks.h"
#include "solver/discrete/whole_by_sat.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

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
          solver_(preparation, seed, stop),
          metropolis_(preparation.example(), preparation.parameters(), seed) {}

    Result<Synthesis> in_blocks(
        const Blocks& blocks, const Checkpoint* from, std::uint32_t threads
    ) {
        auto schedule = schedule_blocks(problem_.size, blocks.layout, kBlockCountMax);
        if (!schedule) {
            return tl::unexpected(std::move(schedule.error()));
        }
        if (problem_.start) {
            std::erase_if(*schedule, [this](const Box& block) { return is_all_kept(block); });
        }
        const auto initial = find_initial_model(preparation_, solver_.search(), seed_, stop_);
        if (!initial) {
            return tl::unexpected(initial.error());
        }
        labels_ = *initial->labels;
        if (from != nullptr) {
            go_on_from(*from, schedule->size());
        }
        solver_.begin(labels_);
        solver_.expect(*initial->labels);
        metropolis_.start(labels_);
        blocks_total_ = static_cast<std::uint32_t>(schedule->size());
        observer_.on_start(blocks_total_, labels_);
        if (!modify_all(*schedule, *initial->labels, blocks.attempts, threads)) {
            return tl::unexpected(cancelled());
        }
        return finish(initial->is_searched ? 1 : changed_from(*initial->labels));
    }

    Result<Synthesis> at_once(const Checkpoint* from) {
        labels_.assign(problem_.size.cell_count(), kNoLabel);
        blocks_total_ = 1;
        const auto changed = [this] { return problem_.start ? changed_from({}) : 1; };
        if (from != nullptr && from->tally.accepted() > 0) {
            go_on_from(*from, blocks_total_);
            observer_.on_start(blocks_total_, labels_);
            return finish(changed());
        }
        observer_.on_start(blocks_total_, {});
        const Box whole = Box::whole(problem_.size);
        solver_.begin(labels_);
        std::vector<std::uint32_t> dead_ends(labels_.size());
        const BlockResult result = solver_.attempt(labels_, whole, 0, kWholeAttempts, dead_ends);
        switch (result.outcome) {
            case BlockOutcome::kAccepted:
                report(whole, result);
                return finish(changed());
            case BlockOutcome::kStopped:
                return tl::unexpected(cancelled());
            case BlockOutcome::kImpossible:
                return tl::unexpected(contradiction_of(preparation_.example(), problem_, result));
            case BlockOutcome::kReverted:
                break;
        }
        auto settled = settle_by_sat(problem_, seed_, stop_);
        if (!settled) {
            return tl::unexpected(std::move(settled.error()));
        }
        if (!*settled || make_board(problem_, problem_.member_rules)->find_violated(**settled)) {
            return tl::unexpected(Error{
                ErrorCode::kGaveUp,
                "no model was found in " + std::to_string(kWholeAttempts) +
                    " attempts at the whole at once; blocks succeed more often",
                {},
                hottest_of(problem_.size, dead_ends)});
        }
        labels_ = std::move(**settled);
        report(
            whole, {BlockOutcome::kAccepted, result.attempts, SolvedBy::kSat, result.backtracks}
        );
        return finish(changed());
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

    [[nodiscard]] bool is_all_kept(const Box& block) const {
        bool all = true;
        for_each_cell(block, [&](const Cell& cell) {
            all = all && problem_.start->is_kept[problem_.size.index(cell)] != 0;
        });
        return all;
    }

    // Share of sites that differ from the model that this one started from.
    [[nodiscard]] double changed_from(std::span<const Label> initial) const {
        const std::span<const Label> before = problem_.start ? problem_.start->labels : initial;
        Site changed = 0;  // of four bytes: half as many vectors as of eight
        for (std::size_t site = 0; site < labels_.size(); ++site) {
            changed += Site{labels_[site] != before[site]};
        }
        return static_cast<double>(changed) / static_cast<double>(labels_.size());
    }

    // False when it was stopped; so is that below.
    bool modify_all(
        std::span<const Box> schedule,
        std::span<const Label> usual,
        std::uint32_t attempts,
        std::uint32_t threads
    ) {
        // What speaks of the whole makes a block depend on all before it.
        const bool is_local = problem_.member_rules.empty() && problem_.symmetries == nullptr &&
                              !metropolis_.is_asked_for();
        if (threads <= 1 || !is_local) {
            return modify_in_turn(schedule, attempts);
        }
        return modify_in_parallel(
            preparation_,
            solver_,
            seed_,
            {schedule, block_index_, attempts, threads, usual},
            labels_,
            stop_,
            [this](const ModifiedBlock& block) { report(block.changed, block.result); }
        );
    }

    bool modify_in_turn(std::span<const Box> schedule, std::uint32_t attempts) {
        for (const Box& block : schedule.subspan(block_index_)) {
            const bool may_be_declined = metropolis_.is_asked_for();
            const Box reach = may_be_declined ? solver_.reach(block) : Box{};
            copy_out(problem_.size, labels_, reach, before_);
            ModifiedBlock modified = solver_.modify(labels_, block, block_index_, attempts);
            BlockResult& result = modified.result;
            if (result.outcome == BlockOutcome::kStopped) {
                return false;
            }
            if (result.outcome == BlockOutcome::kAccepted && may_be_declined &&
                !metropolis_.keeps(block_index_, reach, before_, labels_)) {
                copy_in(problem_.size, before_, reach, labels_);
                solver_.take_back(labels_, reach);
                result.outcome = BlockOutcome::kReverted;
                ++stats_.blocks.declined;
            }
            report(modified.changed, result);
        }
        return true;
    }

    void report(const Box& block, const BlockResult& result) {
        check(
            result.outcome != BlockOutcome::kImpossible,
            "a block of a consistent model was found impossible"
        );
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
        if (preparation_.parameters().order.is_chosen_for_it) {
            stats_.order = preparation_.order();
        }
        if (metropolis_.is_asked_for()) {
            stats_.objective = metropolis_.value();
        }
        return {problem_.size, std::move(labels_), stats_};
    }

    Preparation& preparation_;
    const Problem& problem_;
    std::uint64_t seed_;
    Observer& observer_;
    const std::stop_token& stop_;
    BlockSolver solver_;
    Metropolis metropolis_;
    std::vector<Label> before_;  // within reach of the block in hand, where it may be taken back
    std::vector<Label> labels_;
    std::uint32_t block_index_ = 0;
    std::uint32_t blocks_total_ = 0;
    SynthesisStats stats_;
};

// How a model is made, its seed aside.
struct Circumstances {
    Preparation& preparation;
    Observer& observer;
    const std::stop_token& stop;
    const Checkpoint* from = nullptr;
    std::uint32_t threads = 1;
};

Result<Synthesis> make_one(const Circumstances& how, std::uint64_t seed) {
    const auto& blocks = *how.preparation.parameters().blocks;
    Run run(how.preparation, seed, how.observer, how.stop);
    return blocks ? run.in_blocks(*blocks, how.from, how.threads) : run.at_once(how.from);
}

class NoObserver final : public Observer {
  public:
    void on_start(std::uint32_t /*blocks_total*/, std::span<const Label> /*model*/) override {}

    void on_block(const BlockReport& /*report*/) override {}
};

Result<Synthesis> make_best_of(
    std::uint32_t candidates, const Circumstances& how, std::uint64_t seed
) {
    auto best = find_best_seed(
        how.preparation.example(),
        how.preparation.parameters(),
        candidates,
        seed,
        how.threads,
        [&how](std::uint64_t candidate) -> Result<std::vector<Label>> {
            NoObserver nobody;
            auto made = make_one({how.preparation, nobody, how.stop}, candidate);
            if (!made) {
                return tl::unexpected(std::move(made.error()));
            }
            return std::move(made->labels);
        }
    );
    if (!best) {
        return tl::unexpected(std::move(best.error()));
    }
    auto made = make_one(how, best->seed);
    if (made) {
        made->stats.objective = best->value;
        made->stats.candidates = std::move(best->candidates);
    }
    return made;
}

// How many models the best is to be chosen from; 0: none is asked for.
std::uint32_t candidates_asked_for(const Parameters& parameters) {
    for (const Constraint& constraint : parameters.constraints) {
        if (const auto* best = std::get_if<BestOf>(&constraint.rule)) {
            return best->n;
        }
    }
    return 0;
}

}  // namespace

Result<Synthesis> synthesise(
    Preparation& preparation,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    const std::uint32_t candidates = candidates_asked_for(preparation.parameters());
    const Circumstances how = {preparation, observer, stop, from, threads};
    auto made = candidates == 0 ? make_one(how, seed) : make_best_of(candidates, how, seed);
    if (!made && made.error().code == ErrorCode::kContradiction) {
        return tl::unexpected(explain(
            std::move(made.error()),
            preparation.example(),
            preparation.parameters(),
            preparation.problem(),
            stop
        ));
    }
    return made;
}

Result<Synthesis> synthesise(
    const Example& example,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    const std::shared_ptr<const Example> not_owned(std::shared_ptr<const Example>(), &example);
    const auto preparation = Preparation::make(not_owned, parameters);
    if (!preparation) {
        return tl::unexpected(preparation.error());
    }
    return synthesise(**preparation, seed, observer, stop, from, threads);
}

}  // namespace modelsynth::discrete
