#pragma once

#include "solver/continuous/example.h"

#include <optional>

namespace modelsynth::continuous {

// Where a face's border goes through itself, or turns back on itself, in metres; nothing where it
// does not. A border that touches itself does not cross, and two corners at one place are not told
// from that.
//
// Requires:  three or more corners, numbers in range, finite places, all in one plane.
// Tolerance: corners closer than `tolerance` (metres) to an edge lie on it.
// Cost:      O(corners^2) at worst. Thread-safe.
[[nodiscard]] std::optional<Point> find_self_crossing(
    const Polyhedron& solid, const Face& face, double tolerance
);

}  // namespace modelsynth::continuous
