#include "solver/core/vector_level.h"

#include <algorithm>
#include <atomic>

namespace modelsynth {

namespace {

VectorLevel detect() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
        __builtin_cpu_supports("bmi2") != 0) {
        return VectorLevel::kAvx2;
    }
#endif
    return VectorLevel::kPortable;
}

std::atomic<VectorLevel>& limit() {
    static std::atomic<VectorLevel> value = VectorLevel::kAvx2;
    return value;
}

}  // namespace

VectorLevel vector_level() {
    static const VectorLevel detected = detect();
    return std::min(detected, limit().load(std::memory_order_relaxed));
}

void limit_vector_level(VectorLevel level) { limit().store(level, std::memory_order_relaxed); }

}  // namespace modelsynth
