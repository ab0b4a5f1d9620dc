#pragma once

#include <algorithm>
#include <cstdint>

namespace modelsynth::discrete {

// A conflict of CaDiCaL takes about as long as looking at this many cells.
inline constexpr std::uint64_t kConflictEffort = 100;

// What may still be done to explain a failure, counted in cells looked at and never by a clock, so
// that equal input gives equal answers on any machine. Not thread-safe.
class Effort {
  public:
    explicit Effort(std::uint64_t most) : left_(most) {}

    // False when less than that is left; then nothing is taken.
    [[nodiscard]] bool take(std::uint64_t cells) {
        if (cells > left_) {
            return false;
        }
        left_ -= cells;
        return true;
    }

    // Takes what was done already, or all that is left.
    void spend(std::uint64_t cells) { left_ -= std::min(cells, left_); }

  private:
    std::uint64_t left_;
};

}  // namespace modelsynth::discrete
