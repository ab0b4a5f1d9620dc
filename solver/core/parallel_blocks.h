#pragma once

#include "solver/core/block_queue.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace modelsynth {

// Solves the blocks of a schedule on several threads, those that do not meet at the same time, and
// reports them on the calling thread in the order of the schedule. What a block comes to must not
// depend on blocks that it does not meet; then nothing depends on the number of threads.
template <class Solved>
class ParallelBlocks {
  public:
    // What becomes of a block; nothing when it was stopped, and with it all others.
    using Solver = std::function<std::optional<Solved>(std::uint32_t block)>;
    using Report = std::function<void(std::uint32_t block, Solved& solved)>;

    // `reaches`: by block, what it may change; blocks before `first` are done.
    ParallelBlocks(
        const GridSize& model, Periodic periodic, std::span<const Box> reaches, std::uint32_t first
    )
        : count_(reaches.size()),
          first_(first),
          queue_(model, periodic, reaches, first, run_ahead(reaches)),
          // One more than run ahead: the oldest is being reported while the newest is solved.
          solved_(run_ahead(reaches) + 1) {}

    // `own` solves on the calling thread, and each other one has a solver of its own.
    // False: it was stopped before the last block. Throws what a solver or `report` throws.
    [[nodiscard]] bool run(
        std::uint32_t threads,
        const Solver& own,
        const std::function<Solver()>& make_solver,
        const Report& report
    ) {
        std::size_t reported = first_;
        {
            std::vector<std::jthread> helpers;
            // However this ends, helpers are told before they are waited for.
            const std::unique_ptr<BlockQueue, void (*)(BlockQueue*)> at_end(
                &queue_, [](BlockQueue* queue) { queue->stop(); }
            );
            for (std::uint32_t i = 1; i < threads; ++i) {
                try {
                    helpers.emplace_back([this, &make_solver] { help(make_solver); });
                } catch (const std::system_error&) {
                    break;  // no more threads can be had
                }
            }
            for (auto step = queue_.next_step(); step.kind != BlockQueue::Step::Kind::kEnd;
                 step = queue_.next_step()) {
                if (step.kind == BlockQueue::Step::Kind::kSolve) {
                    solve(own, step.block);
                } else {
                    report(step.block, *slot_of(step.block));
                    slot_of(step.block).reset();
                    ++reported;
                }
            }
        }
        if (fault_) {
            std::rethrow_exception(fault_);
        }
        return reported == count_;
    }

  private:
    // Blocks that wait to be reported while others are solved. Every further thread needs a further
    // row of them: by simulation of 199 rows of 199 equal blocks, 16 threads are 4.0 times as fast
    // as one when 512 may wait, and 15.2 times when 4096 may.
    static constexpr std::size_t kAheadMin = 512;
    static constexpr std::size_t kAheadMax = 4096;
    // More than kAheadMin only as far as they change no more cells than this together.
    static constexpr std::size_t kCellsAheadMax = std::size_t{1} << 23;

    static std::uint32_t run_ahead(std::span<const Box> reaches) {
        std::size_t largest = 1;
        for (const Box& reach : reaches) {
            largest = std::max(largest, reach.size().cell_count());
        }
        const std::size_t many = std::clamp(kCellsAheadMax / largest, kAheadMin, kAheadMax);
        return static_cast<std::uint32_t>(std::clamp<std::size_t>(reaches.size(), 1, many));
    }

    std::optional<Solved>& slot_of(std::uint32_t block) { return solved_[block % solved_.size()]; }

    void solve(const Solver& solver, std::uint32_t block) {
        std::optional<Solved>& slot = slot_of(block);
        slot = solver(block);
        if (slot) {
            queue_.finish(block);
        } else {
            queue_.stop();
        }
    }

    // Solves what there is until there is no more.
    void help(const std::function<Solver()>& make_solver) {
        try {
            const Solver solver = make_solver();
            while (const auto block = queue_.take()) {
                solve(solver, *block);
            }
        } catch (...) {
            const std::lock_guard lock(fault_mutex_);
            fault_ = std::current_exception();
            queue_.stop();
        }
    }

    std::size_t count_;
    std::uint32_t first_;
    BlockQueue queue_;
    std::vector<std::optional<Solved>> solved_;
    std::mutex fault_mutex_;
    std::exception_ptr fault_;
};

}  // namespace modelsynth
