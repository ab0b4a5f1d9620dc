#include "solver/discrete/parallel_blocks.h"

#include "solver/core/block_queue.h"
#include "solver/discrete/box_labels.h"

#include <exception>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace modelsynth::discrete {

namespace {

// Blocks that wait to be reported while others are solved.
constexpr std::uint32_t kRunAheadMax = 512;

struct Solved {
    ModifiedBlock block;
    std::vector<Label> labels;  // of the box that changed, when it was accepted
};

// What each block may change.
std::vector<Box> reaches_of(const BlockSolver& solver, std::span<const Box> schedule) {
    std::vector<Box> reaches;
    reaches.reserve(schedule.size());
    for (const Box& block : schedule) {
        reaches.push_back(solver.reach(block));
    }
    return reaches;
}

class ParallelRun {
  public:
    ParallelRun(
        const GridSize& size,
        Periodic periodic,
        const ParallelBlocks& blocks,
        const BlockSolver& solver,
        std::span<const Label> model
    )
        : size_(size),
          blocks_(blocks),
          reaches_(reaches_of(solver, blocks.schedule)),
          queue_(size, periodic, reaches_, blocks.first, kRunAheadMax),
          ahead_(model.begin(), model.end()),
          // One more than run ahead: the oldest is being reported while the newest is solved.
          solved_(kRunAheadMax + 1) {}

    // Solves what there is until there is no more.
    void help(Preparation& preparation, std::uint64_t seed, const std::stop_token& stop) {
        try {
            BlockSolver solver(preparation, seed, stop);
            while (const auto block = queue_.take()) {
                solve(solver, *block);
            }
        } catch (...) {
            const std::lock_guard lock(fault_mutex_);
            fault_ = std::current_exception();
            queue_.stop();
        }
    }

    // The part of the reporting thread. Returns how many blocks of the schedule are reported.
    std::size_t lead(
        BlockSolver& own,
        std::span<Label> model,
        const std::function<void(const ModifiedBlock&)>& report
    ) {
        std::size_t reported = blocks_.first;
        for (auto step = queue_.next_step(); step.kind != BlockQueue::Step::Kind::kEnd;
             step = queue_.next_step()) {
            if (step.kind == BlockQueue::Step::Kind::kSolve) {
                solve(own, step.block);
                continue;
            }
            const Solved& slot = slot_of(step.block);
            if (slot.block.result.outcome == BlockOutcome::kAccepted) {
                copy_in(size_, slot.labels, slot.block.changed, model);
            }
            report(slot.block);
            ++reported;
        }
        return reported;
    }

    void stop() { queue_.stop(); }

    // Once all helpers have ended.
    void rethrow_fault() const {
        if (fault_) {
            std::rethrow_exception(fault_);
        }
    }

  private:
    Solved& slot_of(std::uint32_t block) { return solved_[block % solved_.size()]; }

    void solve(BlockSolver& solver, std::uint32_t block) {
        Solved& slot = slot_of(block);
        slot.block = solver.modify(ahead_, blocks_.schedule[block], block, blocks_.attempts);
        if (slot.block.result.outcome == BlockOutcome::kStopped) {
            queue_.stop();
            return;
        }
        if (slot.block.result.outcome == BlockOutcome::kAccepted) {
            copy_out(size_, ahead_, slot.block.changed, slot.labels);
        }
        queue_.finish(block);
    }

    const GridSize size_;
    const ParallelBlocks& blocks_;
    const std::vector<Box> reaches_;
    BlockQueue queue_;
    std::vector<Label> ahead_;
    std::vector<Solved> solved_;
    std::mutex fault_mutex_;
    std::exception_ptr fault_;
};

}  // namespace

bool modify_in_parallel(
    Preparation& preparation,
    BlockSolver& own,
    std::uint64_t seed,
    const ParallelBlocks& blocks,
    std::span<Label> model,
    const std::stop_token& stop,
    const std::function<void(const ModifiedBlock&)>& report
) {
    const Problem& problem = preparation.problem();
    ParallelRun run(problem.size, problem.periodic, blocks, own, model);
    std::size_t reported = 0;
    {
        std::vector<std::jthread> helpers;
        // However this ends, helpers are told before they are waited for.
        const std::unique_ptr<ParallelRun, void (*)(ParallelRun*)> at_end(
            &run, [](ParallelRun* it) { it->stop(); }
        );
        for (std::uint32_t i = 1; i < blocks.threads; ++i) {
            try {
                helpers.emplace_back([&] { run.help(preparation, seed, stop); });
            } catch (const std::system_error&) {
                break;  // no more threads can be had
            }
        }
        reported = run.lead(own, model, report);
    }
    run.rethrow_fault();
    return reported == blocks.schedule.size();
}

}  // namespace modelsynth::discrete
