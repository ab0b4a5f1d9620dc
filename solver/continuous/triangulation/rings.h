#pragma once

#include "solver/continuous/triangulation/triangulation.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

// Ears are cut off one by one (Meisters 1975), the best shaped first, after every hole was joined
// to the outer boundary by a bridge, an edge there and back.
//
// Loops that touch make this delicate: at one place there may be several corners. First of all,
// loops are therefore linked anew at such places, so that what is between the two edges of a corner
// is inside and no other edge is there ("facing" corners). A hole that touches the outer boundary
// thereby becomes part of it, and parts that hang together only at a place become rings of their
// own. Bridges and cuts keep this. It follows that other corners at the places of an ear cannot be
// in its way: an edge from there into the triangle would have to leave it across an edge of the
// ring.
//
// An ear has to be strictly convex and may have no other place of the rings in it, nor on its
// border. In exact arithmetic there is always one: a simple polygon with flat corners has a
// triangulation without degenerate triangles, and a cut leaves another such polygon.

namespace modelsynth::continuous::rings {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Twice the signed area of the triangle.
inline double turn(const Point2& a, const Point2& b, const Point2& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

inline double distance_squared(const Point2& a, const Point2& b) {
    return (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
}

// Where the loops have vertices: points that are the same but for errors are one place.
struct Places {
    double tolerance = 0;
    std::vector<Point2> at;
    std::vector<std::uint32_t> number;  // the smallest of the points there
};

// One pass of a ring through a place. Inside is to the left of the ring.
struct Corner {
    std::uint32_t place = kNone;
    std::uint32_t prev = kNone;  // the corner itself, as is next: no longer in a ring
    std::uint32_t next = kNone;
};

using Corners = std::vector<Corner>;

inline void link(Corners& corners, std::uint32_t from, std::uint32_t to) {
    corners[from].next = to;
    corners[to].prev = from;
}

// How far apart points may be that are one; see triangulate().
[[nodiscard]] double tolerance_for(std::span<const Point2> points, const Loop& vertices);

// Of every vertex its place, added to `places` if there is none yet.
[[nodiscard]] std::vector<std::uint32_t> find_places(
    std::span<const Point2> points, const Loop& vertices, Places& places
);

// The corners of one loop, linked; a place that follows itself is one corner.
void add_ring(std::span<const std::uint32_t> places, Corners& corners);

// Links corners that are at one place anew so that they face the inside.
void face_inside(const Places& places, Corners& corners);

}  // namespace modelsynth::continuous::rings
