#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/import/half_edges.h"

#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A face of a solid made of triangles.
struct MergedFace {
    std::vector<HalfEdge> border;          // each begins at a corner of the face
    std::vector<std::uint32_t> triangles;  // those that it is made of, the first one first
};

// Triangles side by side that lie in one plane as polygons. Where these would have a hole, would
// touch themselves at a corner or would have more corners than a face may, they stay triangles.
// A triangle without height lies in the plane of that at its longest edge.
//
// Requires: `mates` as find_mates() gives it, nowhere open; `corners` the number of the corner at
//           which each half-edge begins, so that corners of solids that touch differ.
//           Corners closer than `tolerance` (metres) to a plane lie in it.
// Ensures:  the faces of a closed solid are those of a closed solid. Faces are in the order of
//           their first triangles.
// Cost:     O(n log n). Thread-safe.
[[nodiscard]] std::vector<MergedFace> merge_faces(
    std::span<const Point> points,
    std::span<const Triangle> triangles,
    std::span<const HalfEdge> mates,
    std::span<const std::uint32_t> corners,
    double tolerance
);

}  // namespace modelsynth::continuous
