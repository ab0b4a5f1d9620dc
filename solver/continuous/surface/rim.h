#pragma once

#include "solver/continuous/example.h"

#include <array>
#include <cstdint>
#include <vector>

namespace modelsynth::continuous {

// A side of a box: 2 * axis, + 1 where the coordinate is largest.
using BoxSide = std::uint8_t;
inline constexpr std::size_t kBoxSides = 6;

// A set of sides, side i at bit i.
using BoxSides = std::uint8_t;

// What a plane and a box have in common: a convex polygon.
struct Rim {
    std::vector<Point> corners;  // counter-clockwise seen against the normal
    std::vector<BoxSide> sides;  // from corner i to the next one it runs along this side
};

// Empty where the plane only touches the box or misses it. Requires: a normal of unit length.
[[nodiscard]] Rim rim_of(const Bounds& box, const Point& normal, double offset);

// The whole side of a box; the normal is the one that points out of it.
[[nodiscard]] Rim rim_of(const Bounds& box, BoxSide side);

[[nodiscard]] Point normal_of(BoxSide side);

}  // namespace modelsynth::continuous
