#include "solver/discrete/synthesis.h"

#include "solver/core/block_queue.h"
#include "solver/core/block_schedule.h"
#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/explanation/conflict.h"
#include "solver/discrete/explanation/explain.h"
#include "solver/discrete/initial_model.h"
#include "solver/discrete/whole_by_sat.h"

#include <exception>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

// Blocks that wait to be reported while others are solved, and the most blocks for which the time
// to find their dependencies, before the first one is solved, goes unnoticed.
constexpr std::uint32_t kRunAheadMax = 512;
constexpr std::size_t kParallelBlocksMax = 5'000;

Error cancelled() { return {ErrorCode::kCancelled, "the synthesis was stopped", {}}; }

// Modifies blocks of one run; one per thread.
class BlockSolver {
  public:
    BlockSolver(Preparation& preparation, std::uint64_t seed, const std::stop_token& stop)
        : preparation_(preparation), seed_(seed), stop_(stop), search_(preparation.take_search()) {}

    BlockSolver(const BlockSolver&) = delete;
    BlockSolver& operator=(const BlockSolver&) = delete;

    ~BlockSolver() { preparation_.give_back(std::move(search_)); }

    [[nodiscard]] Preparation::Search& search() { return *search_; }

    // The model stands as it is from now on, but for what modify() makes of it; it satisfies the
    // member rules where it is complete.
    void begin(std::span<const Label> labels) {
        const Problem& problem = preparation_.problem();
        if (!problem.member_rules.empty()) {
            board_ = make_board(problem, problem.member_rules);
            board_->start(labels);
        }
    }

    BlockResult modify(
        std::span<Label> labels,
        const Box& block,
        std::uint32_t index,
        std::uint32_t attempts,
        std::span<std::uint32_t> dead_ends = {}
    ) {
        if (stop_.stop_requested()) {
            return {BlockOutcome::kStopped};
        }
        const Problem& problem = preparation_.problem();
        const GridPart part(problem.size, problem.periodic, block);
        const GridSize shape = block.size();
        if (shape != scan_shape_) {
            scan_ = column_order(shape);
            scan_shape_ = shape;
        }
        BlockOptions options = {attempts, preparation_.parameters().order, scan_};
        options.board = board_.get();
        options.dead_ends = dead_ends;
        return search_->modify(part, labels, options, {seed_, index, 0, 0}, stop_);
    }

  private:
    Preparation& preparation_;
    std::uint64_t seed_;
    const std::stop_token& stop_;
    std::unique_ptr<Preparation::Search> search_;
    std::unique_ptr<ConstraintBoard> board_;  // null: the problem has no member rules
    std::vector<Site> scan_;
    GridSize scan_shape_;
};

void copy_out(
    const GridSize& size, std::span<const Label> labels, const Box& box, std::vector<Label>& copy
) {
    copy.clear();
    for_each_cell(box, [&](const Cell& cell) { copy.push_back(labels[size.index(cell)]); });
}

void copy_in(
    const GridSize& size, std::span<const Label> copy, const Box& box, std::span<Label> labels
) {
    std::size_t i = 0;
    for_each_cell(box, [&](const Cell& cell) { labels[size.index(cell)] = copy[i++]; });
}

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
          solver_(preparation, seed, stop) {}

    Result<Synthesis> in_blocks(
        const Blocks& blocks, const Checkpoint* from, std::uint32_t threads
    ) {
        auto schedule = schedule_blocks(problem_.size, blocks.layout, kBlockCountMax);
        if (!schedule) {
            return tl::unexpected(std::move(schedule.error()));
        }
        const auto initial = find_initial_model(preparation_, solver_.search(), seed_, stop_);
        if (!initial) {
            return tl::unexpected(initial.error());
        }
        labels_ = initial->labels;
        if (from != nullptr) {
            go_on_from(*from, schedule->size());
        }
        solver_.begin(labels_);
        blocks_total_ = static_cast<std::uint32_t>(schedule->size());
        observer_.on_start(blocks_total_, labels_);
        // Constraints on the whole make a block depend on all before it.
        const bool in_parallel =
            threads > 1 && schedule->size() <= kParallelBlocksMax && problem_.member_rules.empty();
        if (!(in_parallel ? modify_in_parallel(*schedule, blocks.attempts, threads)
                          : modify_in_turn(*schedule, blocks.attempts))) {
            return tl::unexpected(cancelled());
        }
        if (initial->is_searched) {
            return finish(1);
        }
        std::size_t changed = 0;
        for (std::size_t site = 0; site < labels_.size(); ++site) {
            changed += std::size_t{labels_[site] != initial->labels[site]};
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
        solver_.begin(labels_);
        std::vector<std::uint32_t> dead_ends(labels_.size());
        const BlockResult result = solver_.modify(labels_, whole, 0, kWholeAttempts, dead_ends);
        switch (result.outcome) {
            case BlockOutcome::kAccepted:
                report(whole, result);
                return finish(1);
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
        if (!*settled) {
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
        return finish(1);
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

    // False when it was stopped; so are those below.
    bool modify_in_turn(std::span<const Box> schedule, std::uint32_t attempts) {
        for (const Box& block : schedule.subspan(block_index_)) {
            const BlockResult result = solver_.modify(labels_, block, block_index_, attempts);
            if (result.outcome == BlockOutcome::kStopped) {
                return false;
            }
            check_possible(result);
            report(block, result);
        }
        return true;
    }

    // Blocks that do not touch are modified at the same time, in a copy of the model that is ahead
    // of what was reported.
    bool modify_in_parallel(
        std::span<const Box> schedule, std::uint32_t attempts, std::uint32_t threads
    ) {
        struct Solved {
            BlockResult result;
            std::vector<Label> labels;  // of an accepted block
        };

        const BlockDependencies dependencies =
            find_dependencies(problem_.size, problem_.periodic, schedule, block_index_);
        BlockQueue queue(dependencies, block_index_, kRunAheadMax);
        std::vector<Label> ahead = labels_;
        // One more than run ahead: the oldest is being reported while the newest is solved.
        std::vector<Solved> solved(kRunAheadMax + 1);
        const auto solve = [&](BlockSolver& solver, std::uint32_t block) {
            Solved& slot = solved[block % solved.size()];
            slot.result = solver.modify(ahead, schedule[block], block, attempts);
            if (slot.result.outcome == BlockOutcome::kStopped) {
                queue.stop();
                return;
            }
            check_possible(slot.result);
            if (slot.result.outcome == BlockOutcome::kAccepted) {
                copy_out(problem_.size, ahead, schedule[block], slot.labels);
            }
            queue.finish(block);
        };
        std::exception_ptr fault;
        std::mutex fault_mutex;
        const auto help = [&] {
            try {
                BlockSolver solver(preparation_, seed_, stop_);
                while (const auto block = queue.take()) {
                    solve(solver, *block);
                }
            } catch (...) {
                const std::lock_guard lock(fault_mutex);
                fault = std::current_exception();
                queue.stop();
            }
        };
        {
            std::vector<std::jthread> helpers;
            // However this ends, helpers are told before they are waited for.
            const std::unique_ptr<BlockQueue, void (*)(BlockQueue*)> at_end(
                &queue, [](BlockQueue* it) { it->stop(); }
            );
            for (std::uint32_t i = 1; i < threads; ++i) {
                try {
                    helpers.emplace_back(help);
                } catch (const std::system_error&) {
                    break;  // no more threads can be had
                }
            }
            for (auto step = queue.next_step(); step.kind != BlockQueue::Step::Kind::kEnd;
                 step = queue.next_step()) {
                if (step.kind == BlockQueue::Step::Kind::kSolve) {
                    solve(solver_, step.block);
                    continue;
                }
                const Solved& slot = solved[step.block % solved.size()];
                if (slot.result.outcome == BlockOutcome::kAccepted) {
                    copy_in(problem_.size, slot.labels, schedule[step.block], labels_);
                }
                report(schedule[step.block], slot.result);
            }
        }
        if (fault) {
            std::rethrow_exception(fault);
        }
        return block_index_ == schedule.size();
    }

    static void check_possible(const BlockResult& result) {
        check(
            result.outcome != BlockOutcome::kImpossible,
            "a block of a consistent model was found impossible"
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
    BlockSolver solver_;
    std::vector<Label> labels_;
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
    const Checkpoint* from,
    std::uint32_t threads
) {
    const auto& blocks = *preparation.parameters().blocks;
    Run run(preparation, seed, observer, stop);
    auto made = blocks ? run.in_blocks(*blocks, from, threads) : run.at_once(from);
    if (!made && made.error().code == ErrorCode::kContradiction) {
        return tl::unexpected(
            explain(std::move(made.error()), preparation.example(), preparation.parameters(), stop)
        );
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
