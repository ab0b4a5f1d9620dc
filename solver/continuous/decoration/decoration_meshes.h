#pragma once

#include "solver/continuous/decoration/placed_decorations.h"

#include <cstddef>
#include <vector>

namespace modelsynth::continuous {

// A solid with flat faces, open where a sweep is mitred.
struct SweptMesh {
    std::vector<Point> corners;
    std::vector<Face> faces;     // counter-clockwise seen from outside; caps need not be convex
    std::vector<Point> normals;  // of the faces, unit length
};

// All sweeps that meet in mitres are closed together: they have the same corners there.
[[nodiscard]] SweptMesh mesh_of(const Sweep& sweep);

[[nodiscard]] std::size_t triangle_count(const Sweep& sweep);

// The triangles of a mesh, three corners after each other, where it was put.
[[nodiscard]] std::vector<ShapeCorner> triangles_of(const PlacedMesh& mesh);

// Where a decoration is counted as being: the middle of an edge, or the corner.
[[nodiscard]] Point place_of(const Sweep& sweep);

// Whether a place belongs to a part of a model: of two parts beside each other it is in one.
[[nodiscard]] bool is_in_part(const Point& place, const Bounds& part);

}  // namespace modelsynth::continuous
