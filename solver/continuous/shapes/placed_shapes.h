#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/surface/surface.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth::continuous {

// So many triangles of shapes at most in a model; beyond that all of them are left boxes. What is
// left of them is for decorations.
inline constexpr std::size_t kShapeTrianglesMax = 1'000'000;

struct PlacedShape {
    ObjectId object = 1;
    Bounds box;
};

// The shapes of a model, and which polygons of its surface they replace.
struct PlacedShapes {
    std::vector<PlacedShape> shapes;        // in the order of their first polygons
    std::vector<std::uint8_t> is_replaced;  // by polygon
    std::size_t triangle_count = 0;         // of all of them
    bool are_too_many = false;
};

// Finds the boxes of objects that have shapes, by the polygons that hang together along edges.
// What is no box, cut off where the example was or carved by other solids, stays as it is.
// Cost: O(polygons log polygons). Deterministic.
[[nodiscard]] PlacedShapes place_shapes(const Example& example, const Surface& surface);

// A corner of a shape's triangle.
struct ShapeCorner {
    Point place;
    Point normal;  // unit length, smooth or not
};

[[nodiscard]] std::size_t triangle_count(const Shape& shape);

// The triangles of a shape, three corners after each other, as they lie over a box.
[[nodiscard]] std::vector<ShapeCorner> triangles_of(const Shape& shape, const Bounds& box);

// Those of a shape as it is.
[[nodiscard]] std::vector<ShapeCorner> triangles_of(const Shape& shape);

}  // namespace modelsynth::continuous
