#pragma once

#include "solver/continuous/example.h"

#include <cstdint>
#include <vector>

namespace modelsynth::continuous {

// Makes corners of triangles that are one but for noise one. Meshes have a vertex of its own at a
// corner for every face, and single precision.
//
// Points closer than `tolerance` (metres) become the first of them. Then triangles across an axis
// whose places along it are closer get the most frequent of these, so that faces along the axes lie
// exactly in one plane. No point moves by more than some tolerances.
// Shape:    `points` three by three; returns a number for each, and `points` is then the places of
//           those numbers.
// Requires: coordinates below 1e15 tolerances, tolerance > 0.
// Cost:     O(n log n). Thread-safe.
[[nodiscard]] std::vector<std::uint32_t> weld(std::vector<Point>& points, double tolerance);

}  // namespace modelsynth::continuous
