#pragma once

#include "solver/core/block_schedule.h"
#include "solver/core/box_index.h"
#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <queue>
#include <span>
#include <vector>

namespace modelsynth {

// Hands the blocks of a schedule to several threads, each as soon as the earlier ones that it meets
// are finished, and to one of them, the reporting thread, the finished ones in the order of the
// schedule. Only the blocks that may run ahead of the reports are looked at, so that it costs the
// same at any place of a schedule of any length.
// Cost: memory for run_ahead blocks; O(blocks near by) a block. Thread-safe.
class BlockQueue {
  public:
    // What the reporting thread is to do next.
    struct Step {
        enum class Kind : std::uint8_t { kReport, kSolve, kEnd } kind = Kind::kEnd;
        std::uint32_t block = 0;
    };

    // Blocks before `first` are finished and reported. A block is handed out only when fewer than
    // `run_ahead` wait to be reported before it. Requires: the blocks outlive the queue.
    BlockQueue(
        const GridSize& model,
        Periodic periodic,
        std::span<const Box> blocks,
        std::uint32_t first,
        std::uint32_t run_ahead
    );

    // A block to solve; waits for one. Nothing when there will be none.
    [[nodiscard]] std::optional<std::uint32_t> take();

    // For the reporting thread: to report a block takes precedence.
    [[nodiscard]] Step next_step();

    // The block that take() or next_step() gave is solved.
    void finish(std::uint32_t block);

    // No more blocks are handed out.
    void stop();

  private:
    struct Waiting {
        std::uint32_t waits_for = 0;  // how many earlier blocks
        bool is_finished = false;
        std::vector<std::uint32_t> dependents;  // later blocks that wait for this one
    };

    // The mutex is held in all of these.
    [[nodiscard]] bool is_over() const;

    [[nodiscard]] Waiting& state(std::uint32_t block) { return window_[block % window_.size()]; }

    void admit();
    std::uint32_t start();

    const GridSize model_;
    const Periodic periodic_;
    const std::span<const Box> blocks_;
    std::mutex mutex_;
    std::condition_variable changed_;
    // Of the blocks from next_report_ to admitted_ - 1, each at its number modulo the size.
    std::vector<Waiting> window_;
    BoxIndex waiting_;  // the same blocks
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> ready_;
    std::uint32_t admitted_;
    std::uint32_t started_;  // how many blocks, those before the first one included
    std::uint32_t next_report_;
    bool is_stopped_ = false;
};

}  // namespace modelsynth
