#pragma once

#include <cstddef>
#include <cstdint>

namespace modelsynth {

// How far the back end goes. Counted, never timed, so that equal input has equal outcomes.
struct SatLimits {
    std::size_t literals_max = 3'000'000;  // of the formula, about 100 MB
    std::uint32_t conflicts_max = 20'000;  // dead ends learned from, a second or two
};

}  // namespace modelsynth
