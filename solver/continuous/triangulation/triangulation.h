#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A point of a plane, metres; the second axis is counter-clockwise of the first.
using Point2 = std::array<double, 2>;

// Numbers of points, in order along a closed boundary.
using Loop = std::vector<std::uint32_t>;

// Triangles that fill the area of `outer` less that of `holes`.
//
// Shape:     every triangle is three numbers of points, counter-clockwise.
// Requires:  `outer` counter-clockwise, holes clockwise and inside it; three or more vertices each;
//            numbers below points.size(). Loops may touch each other or themselves at vertices, and
//            may pass these in any way; they do not cross nor share edges, and no vertex lies
//            inside an edge.
// Ensures:   every directed edge of the loops is an edge of exactly one triangle, and every other
//            edge of a triangle is also one of another, the other way round. So all vertices are
//            used, also those between two collinear edges, and the mesh of several faces that share
//            loop edges has no T-junctions. Every triangle is higher than the tolerance.
//            Equal input gives an equal result.
// Tolerance: 1e-12 of the largest coordinate, but as if that were 1e4 at least (so 1e-8 m for what
//            the project makes, whose points are wrong by up to 1e-9 m) and at most a millionth of
//            the loops' extent. Three points are collinear if the triangle is no higher; points no
//            further apart in both coordinates are one, which has the smallest of their numbers in
//            all triangles.
// Otherwise: loops that break these rules, or that bend by less than the tolerance throughout, give
//            thin, clockwise or overlapping triangles; the sum of their signed areas still is that
//            of the loops. Holes that are inside nothing are left out, as are edges between points
//            that are one.
// Cost:      depends on the loops only, not on points.size(). With n vertices and h holes O(h n)
//            and, unless triangles are long throughout, O(n log n) for the rest; 5000 vertices in
//            500 holes take some 20 ms. Thread-safe.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate(
    std::span<const Point2> points, const Loop& outer, std::span<const Loop> holes
);

}  // namespace modelsynth::continuous
