#pragma once

#include <array>
#include <cstdint>

namespace modelsynth {

// Where a stream of random numbers belongs. Streams of different keys are independent, so a block
// draws the same numbers whatever ran before it, beside it or on which thread.
struct RandomKey {
    std::uint64_t seed = 0;
    std::uint32_t block = 0;    // number of the block in its schedule
    std::uint32_t attempt = 0;  // number of the attempt at the block
    std::uint32_t purpose = 0;  // what the numbers are for; see each user
};

// One block of the counter-based generator Philox4x32-10 (Salmon, Moraes, Dror, Shaw: "Parallel
// Random Numbers: As Easy as 1, 2, 3", SC 2011).
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(
    std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key
);

// A stream of random numbers that is a pure function of its key: no shared state, no clock.
// A value; distinct objects may be used from distinct threads.
class RandomStream {
  public:
    explicit RandomStream(const RandomKey& key);

    // Uniform over 0 ... 2^32-1.
    std::uint32_t next();

    // Uniform over 0 ... bound-1 without bias (Lemire 2019).
    // Requires: bound > 0 (checked).
    std::uint32_t below(std::uint32_t bound);

    // Uniform over 0 ... bound-1; the bias is below bound / 2^64.
    // Requires: bound > 0 (checked).
    std::uint64_t below_wide(std::uint64_t bound);

  private:
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> drawn_ = {};
    std::uint32_t left_ = 0;
};

// A seed for another run, as requests have them: at most 2^53 - 1. O(1).
[[nodiscard]] std::uint64_t derive_seed(const RandomKey& key);

}  // namespace modelsynth
