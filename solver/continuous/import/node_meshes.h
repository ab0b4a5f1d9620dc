#pragma once

#include "solver/continuous/example.h"

#include <tl/expected.hpp>

#include <string>
#include <vector>

namespace modelsynth::continuous {

// Why a mesh is not what it should be, as what is said after its node's name.
template <class T>
using FromMesh = tl::expected<T, std::string>;

// A closed mesh as a shape. Triangles side by side in one plane are one face, if that is convex and
// has all their corners. Faces begin as the first of their triangles does, in that order.
// Shape: the places of the corners of triangles, three by three, in any units. Thread-safe.
// Ensures: nothing is checked but that the mesh is closed.
[[nodiscard]] FromMesh<Shape> shape_of_mesh(std::vector<Point> places);

// The outline of a flat mesh that faces along z: x and y are the offsets of its points. It begins
// at the first edge of its triangles that is part of it.
// Shape: as above, metres. Thread-safe.
// Fails: where it is not flat, or its outline is not one closed line.
[[nodiscard]] FromMesh<std::vector<ProfilePoint>> profile_of_mesh(std::vector<Point> places);

}  // namespace modelsynth::continuous
