#pragma once

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <span>
#include <vector>

namespace modelsynth::bench {

struct Taken {
    double milliseconds = 0;
    double processor_milliseconds =
        0;  // of all threads; other work on the machine disturbs it less
};

template <class Work>
[[nodiscard]] Taken time_of(Work work) {
    const auto begun = std::chrono::steady_clock::now();
    const std::clock_t processor_begun = std::clock();
    work();
    const std::clock_t processor_taken = std::clock() - processor_begun;
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - begun;
    return {taken.count(), 1000 * static_cast<double>(processor_taken) / CLOCKS_PER_SEC};
}

// As the server's main(): what is freed is not given back to the system and taken anew, page by
// page. Without it the time of a model depends on what was made before it.
inline void keep_freed_memory() {
    constexpr int kKeptBytes = 32 << 20;
    ::mallopt(M_MMAP_THRESHOLD, kKeptBytes);
    ::mallopt(M_TRIM_THRESHOLD, kKeptBytes);
}

// Requires: at least one value.
[[nodiscard]] inline double median(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
}

}  // namespace modelsynth::bench
