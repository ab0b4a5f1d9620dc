#include "solver/core/random.h"

#include "solver/core/result.h"

namespace modelsynth {

namespace {

// Of 64 x 64 bits the upper 64, by halves: ISO C++ has no 128-bit integer.
std::uint64_t multiply_high(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t a_low = a & 0xFFFFFFFFU;
    const std::uint64_t a_high = a >> 32;
    const std::uint64_t b_low = b & 0xFFFFFFFFU;
    const std::uint64_t b_high = b >> 32;
    const std::uint64_t middle = a_high * b_low + (a_low * b_low >> 32);
    const std::uint64_t carry = (middle & 0xFFFFFFFFU) + a_low * b_high;
    return a_high * b_high + (middle >> 32) + (carry >> 32);
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(
    std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key
) {
    constexpr std::uint64_t kMultiplier0 = 0xD2511F53;
    constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57;
    constexpr std::uint32_t kWeyl0 = 0x9E3779B9;
    constexpr std::uint32_t kWeyl1 = 0xBB67AE85;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = kMultiplier0 * counter[0];
        const std::uint64_t product1 = kMultiplier1 * counter[2];
        counter = {
            static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
            static_cast<std::uint32_t>(product1),
            static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
            static_cast<std::uint32_t>(product0)};
        key[0] += kWeyl0;
        key[1] += kWeyl1;
    }
    return counter;
}

RandomStream::RandomStream(const RandomKey& key)
    : counter_{0, key.block, key.attempt, key.purpose},
      key_{static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)} {}

std::uint32_t RandomStream::next() {
    if (left_ == 0) {
        drawn_ = philox4x32(counter_, key_);
        ++counter_[0];
        left_ = 4;
    }
    return drawn_[--left_];
}

std::uint32_t RandomStream::below(std::uint32_t bound) {
    check(bound > 0, "a random number below zero was asked for");
    std::uint64_t product = std::uint64_t{next()} * bound;
    const std::uint32_t threshold = (0U - bound) % bound;
    while (static_cast<std::uint32_t>(product) < threshold) {
        product = std::uint64_t{next()} * bound;
    }
    return static_cast<std::uint32_t>(product >> 32);
}

std::uint64_t RandomStream::below_wide(std::uint64_t bound) {
    check(bound > 0, "a random number below zero was asked for");
    const std::uint64_t high = next();
    return multiply_high(high << 32 | next(), bound);
}

std::uint64_t derive_seed(const RandomKey& key) {
    RandomStream random(key);
    const std::uint64_t high = random.next() >> 11;
    return high << 32 | random.next();
}

}  // namespace modelsynth
