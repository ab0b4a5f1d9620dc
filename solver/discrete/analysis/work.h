#pragma once

#include <algorithm>
#include <cstdint>
#include <stop_token>
#include <utility>

namespace modelsynth::discrete {

// How much an analysis may do, counted in steps and never by a clock, so that equal input gives
// equal answers on any machine. A step is one propagation over a small grid, or what costs about as
// much. Not thread-safe; one for each analysis.
class Work {
  public:
    Work(std::uint64_t steps_max, std::stop_token stop)
        : left_(steps_max), stop_(std::move(stop)) {}

    // False when nothing is left or the stop token was requested; then nothing is taken.
    [[nodiscard]] bool take() {
        if (left_ == 0 || stop_.stop_requested()) {
            return false;
        }
        --left_;
        ++used_;
        return true;
    }

    [[nodiscard]] std::uint64_t left() const { return left_; }

    [[nodiscard]] std::uint64_t used() const { return used_; }

    [[nodiscard]] const std::stop_token& stop() const { return stop_; }

    // Runs task(Work&) with at most that many of the steps that are left.
    template <class Task>
    auto with_share(std::uint64_t steps_max, Task task) {
        Work share(std::min(steps_max, left_), stop_);
        auto result = task(share);
        left_ -= share.used_;
        used_ += share.used_;
        return result;
    }

  private:
    std::uint64_t left_;
    std::uint64_t used_ = 0;
    std::stop_token stop_;
};

// What became of an attempt to prove something.
enum class ProofOutcome : std::uint8_t {
    kProved,
    kNotProved,  // this way does not prove it; it may be true all the same
    kNoWork,     // the work was used up, or stopped, before it was known
};

}  // namespace modelsynth::discrete
