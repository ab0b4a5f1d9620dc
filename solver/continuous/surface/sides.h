#pragma once

#include "solver/continuous/surface/surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

inline constexpr std::size_t kNoSide = ~std::size_t{0};

// A side of a polygon of an object's surface: a half-edge.
struct Side {
    std::size_t polygon = 0;
    std::uint32_t from = 0;  // points; seen from outside the polygon is to the left
    std::uint32_t to = 0;
    std::size_t next = 0;            // the side that goes on from it round the polygon
    std::size_t twin = kNoSide;      // the other way round, of the polygon across
    Point inwards = Point::Zero();   // in the polygon's plane, across the side; unit length
    Point outwards = Point::Zero();  // the polygon's normal
};

// The unit normals of all polygons, by their corners alone.
[[nodiscard]] std::vector<Point> normals_of(const Surface& surface);

// The sides of an object's polygons, polygon by polygon. Where several pieces of it touch along an
// edge, twins are of one piece: of the polygons there the one that is come to first through the
// inside. Going on from twin to next goes round a corner of one piece.
// Ensures: sides[sides[i].twin].twin == i, where there is a twin; a closed surface has them all.
[[nodiscard]] std::vector<Side> sides_of(
    const Surface& surface, std::span<const Point> normals, ObjectId object
);

}  // namespace modelsynth::continuous
