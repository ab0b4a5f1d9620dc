#pragma once

#include "solver/continuous/example.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// Numbers of points, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

// The edge of triangle h / 3 from its corner h % 3 to the next.
using HalfEdge = std::uint32_t;
inline constexpr HalfEdge kNoHalfEdge = 0xFFFFFFFF;

[[nodiscard]] constexpr HalfEdge next_in_triangle(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }

// For every half-edge the one that runs the other way along the same solid; kNoHalfEdge where the
// surface is open.
// Where several solids touch at an edge, those are mates between which a solid is, so that every
// solid is closed by itself. Edges of more than 32 triangles are left open.
// Requires: three different points a triangle, at different places. Cost: O(n log n). Thread-safe.
[[nodiscard]] std::vector<HalfEdge> find_mates(
    std::span<const Point> points, std::span<const Triangle> triangles
);

// The number of the corner at which each half-edge begins: triangles have one in common only where
// they are around it side by side. Requires: `mates` as above, nowhere open.
[[nodiscard]] std::vector<std::uint32_t> corners_of(std::span<const HalfEdge> mates);

}  // namespace modelsynth::continuous
