#pragma once

#include "solver/continuous/reading/topes.h"
#include "solver/core/result.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// Directions of planes that pass through all points of a lattice are small integers on it. Where
// those of an example are not, as of a pyramid over a pentagon, no spacing has planes of more than
// three of them meet in one point more than once; turned a little they do.
struct Nudged {
    std::vector<Point> normals;  // by family, unit length
    // By family, how far apart planes lie that pass through every so manieth point of the lattice;
    // metres.
    std::vector<double> spacings;
    double largest_degrees = 0;  // by which a normal was turned
};

// The nearest such directions within `degrees` of all families, as small numbers as possible.
// `steps`: of the lattice along x, y and z, metres.
// Nothing when a family has none, or where planes would then lie to each other as they do not in
// the example: the cells and lines of the central arrangement are to be the same.
// Cost: O(families * 17^3). Thread-safe.
[[nodiscard]] std::optional<Nudged> nudge(
    const Topes& topes, const std::array<double, 3>& steps, double degrees
);

}  // namespace modelsynth::continuous
