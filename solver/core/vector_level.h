#pragma once

#include <cstdint>

namespace modelsynth {

// The instructions that inner loops may use. Every level gives the same results.
enum class VectorLevel : std::uint8_t {
    kPortable,  // what every processor of the architecture has
    kAvx2,      // x86-64 with AVX2, BMI1 and BMI2
};

// The highest level that this processor has, or the limit when that is lower. Thread-safe.
[[nodiscard]] VectorLevel vector_level();

// For tests and measurements: whoever asks from now on gets no more than this.
void limit_vector_level(VectorLevel limit);

}  // namespace modelsynth

// Marks a function that is compiled for VectorLevel::kAvx2, whatever the rest is compiled for.
#if defined(__x86_64__)
#define MODELSYNTH_TARGET_AVX2 [[gnu::target("avx2,bmi,bmi2,popcnt,lzcnt")]]
#else
#define MODELSYNTH_TARGET_AVX2
#endif
