#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/import/half_edges.h"

#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A solid made of triangles; without a name and an object yet.
struct TriangleSolid {
    Polyhedron polyhedron;
    std::vector<std::uint32_t> triangles;  // for every face one of those that it is made of
};

// What triangles are the surface of.
struct TriangleSolids {
    std::vector<HalfEdge> open;         // where it is not closed; then there are no solids
    std::vector<TriangleSolid> solids;  // each hangs together
};

// The solids that a soup of triangles encloses, with polygons for faces where that is possible
// (face_merging.h). A hollow belongs to the solid around it. Solids that touch become several, each
// with corners of its own. What crosses itself or looks inwards stays so: see find_solid_faults().
//
// Requires: points that are one are one number (welding.h), three different ones a triangle.
//           Points closer than `tolerance` (metres) to a plane lie in it.
// Ensures:  solids in the order of their first triangles.
// Cost:     O(n log n), and O(n) for every hollow. Thread-safe.
[[nodiscard]] TriangleSolids find_triangle_solids(
    std::span<const Point> points, std::span<const Triangle> triangles, double tolerance
);

}  // namespace modelsynth::continuous
