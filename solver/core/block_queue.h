#pragma once

#include "solver/core/block_schedule.h"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <queue>
#include <vector>

namespace modelsynth {

// Hands the blocks of a schedule to several threads, each as soon as those it waits for are
// finished, and to one of them, the reporting thread, the finished ones in the order of the
// schedule. Thread-safe.
class BlockQueue {
  public:
    // What the reporting thread is to do next.
    struct Step {
        enum class Kind : std::uint8_t { kReport, kSolve, kEnd } kind = Kind::kEnd;
        std::uint32_t block = 0;
    };

    // Blocks before `first` are finished and reported. A block is handed out only when fewer than
    // `run_ahead` wait to be reported before it. Requires: dependencies outlives the queue.
    BlockQueue(const BlockDependencies& dependencies, std::uint32_t first, std::uint32_t run_ahead);

    // A block to solve; waits for one. Nothing when there will be none.
    [[nodiscard]] std::optional<std::uint32_t> take();

    // For the reporting thread: to report a block takes precedence.
    [[nodiscard]] Step next_step();

    // The block that take() or next_step() gave is solved.
    void finish(std::uint32_t block);

    // No more blocks are handed out.
    void stop();

  private:
    [[nodiscard]] bool is_over() const;  // as for those below, the mutex is held
    [[nodiscard]] bool may_start() const;
    std::uint32_t start();

    const BlockDependencies& dependencies_;
    const std::uint32_t run_ahead_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::uint32_t> waits_for_;
    std::vector<bool> finished_;
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> ready_;
    std::uint32_t started_;
    std::uint32_t next_report_;
    bool is_stopped_ = false;
};

}  // namespace modelsynth
