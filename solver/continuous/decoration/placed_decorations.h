#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/shapes/placed_shapes.h"
#include "solver/continuous/surface/surface.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// One end of a sweep: the point (p, q) of the profile comes to at + p * of_p + q * of_q.
struct SweepEnd {
    Point at = Point::Zero();
    Point of_p = Point::Zero();
    Point of_q = Point::Zero();
    bool is_mitred = false;  // another sweep goes on from here; else a cap closes it
};

// A profile along an edge, or along what part of it borders empty space. It is counter-clockwise
// seen from beyond the last end.
struct Sweep {
    ObjectId object = 1;
    const EdgeDecoration* decoration = nullptr;
    std::array<SweepEnd, 2> ends;
};

// A mesh at a corner.
struct PlacedMesh {
    ObjectId object = 1;
    const CornerDecoration* decoration = nullptr;
    Point at = Point::Zero();
    Point outwards = Point::UnitX();  // horizontal, unit length: where its +x looks
};

// In the order of objects, of their decorations and of the surface. Refers to the example.
struct PlacedDecorations {
    std::vector<Sweep> sweeps;
    std::vector<PlacedMesh> meshes;
    bool are_too_many = false;  // with the shapes more than kShapeTrianglesMax: there are none
};

// Finds the edges and corners of a model that its objects' decorations are for: those whose faces
// border empty space, no other object, and that no shape replaces; a face borders it at a corner
// when it does so along both of its edges there. Where the model ends there are none.
// Where just two edges of a decoration meet at a corner, and have a face in common in the same
// part, their sweeps end in one cross-section (a mitre). Ends are capped instead where that would
// be more than kReachMax times as far from the edge as the profile's greatest offset, or beyond the
// other end; and edges at which the profile itself would come so far out have none.
// `normals`: of the families of the surface.
// Deterministic. Cost: O(n log n) for n sides, and for each side of decorated objects the corners
// of the polygons beside it.
inline constexpr double kReachMax = 8;
[[nodiscard]] PlacedDecorations place_decorations(
    const Example& example,
    std::span<const Point> normals,
    const Surface& surface,
    const PlacedShapes& shapes
);

}  // namespace modelsynth::continuous
