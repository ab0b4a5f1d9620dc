#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>

namespace modelsynth::server {

// How fast workers let go of jobs, as the last ones tell. Thread-safe.
class DrainRate {
  public:
    using Clock = std::chrono::steady_clock;

    explicit DrainRate(Clock::time_point begun) : let_go_{begun} {}

    void on_let_go(Clock::time_point now);

    // Whole seconds in which a worker is likely to have let go of another job, from 1 to 60: what
    // one who found the queue full is to wait. Grows while none ends.
    [[nodiscard]] std::uint64_t seconds_to_next(Clock::time_point now) const;

  private:
    static constexpr std::size_t kKept = 16;

    mutable std::mutex mutex_;
    std::deque<Clock::time_point> let_go_;  // the oldest first; at first the beginning
};

}  // namespace modelsynth::server
