#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace modelsynth::testing {

// How far counts are from what weights let expect, in standard deviations of the normal
// distribution that Wilson and Hilferty (1931) turn chi-squared into: above 3.1 once in a thousand
// times. A label of weight 0 that was counted makes it infinite. Requires: two positive weights.
inline double chi_squared_deviation(
    std::span<const std::uint64_t> counts, std::span<const double> weights
) {
    double sum = 0;
    double drawn = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        sum += weights[i];
        drawn += static_cast<double>(counts[i]);
    }
    double chi_squared = 0;
    double freedom = -1;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double expected = drawn * weights[i] / sum;
        const double off = static_cast<double>(counts[i]) - expected;
        if (weights[i] > 0) {
            chi_squared += off * off / expected;
            freedom += 1;
        } else if (counts[i] > 0) {
            return INFINITY;
        }
    }
    const double spread = 2 / (9 * freedom);
    return (std::cbrt(chi_squared / freedom) - (1 - spread)) / std::sqrt(spread);
}

}  // namespace modelsynth::testing
