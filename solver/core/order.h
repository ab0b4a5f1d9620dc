#pragma once

#include <cstdint>

namespace modelsynth {

// Which site is labelled next.
enum class Order : std::uint8_t {
    kScan,          // in a given order, column by column for a grid
    kMinEntropy,    // where the choice is least open by the weights, ties at random
    kFewestLabels,  // where the fewest labels are left, ties at random
    kRandom,        // anywhere
    kGrowth,        // beside what is decided from the beginning, or one site, and so on
};

}  // namespace modelsynth
