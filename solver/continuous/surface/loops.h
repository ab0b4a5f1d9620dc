#pragma once

#include "solver/continuous/surface/rim.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// A border in a plane, on its left the polygon that it is of, seen against the normal.
struct PlaneEdge {
    std::uint32_t from = 0;  // numbers of points
    std::uint32_t to = 0;
    bool is_from_corner = true;  // else the polygon goes straight on there
};

// A piece of a rim that polygons end at, along a side of the box.
struct RimPiece {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    BoxSide side = 0;
};

// What borders in a plane and the plane's rim enclose.
struct PlaneLoops {
    // The outer loop of each polygon counter-clockwise, then its holes clockwise.
    std::vector<std::vector<std::vector<std::uint32_t>>> polygons;
    std::vector<RimPiece> pieces;
};

// Points of a model's surface. Those where it is cut by the model's box are known by their places:
// whatever ends there ends in the same point.
class PointTable {
  public:
    explicit PointTable(const Bounds& box);

    // A new one, within the box.
    std::uint32_t add(const Point& point);

    // The one at a place on the box's sides.
    std::uint32_t on_box(const Point& place);

    [[nodiscard]] const Point& at(std::uint32_t point) const { return points_[point]; }

    // The sides that it lies on.
    [[nodiscard]] BoxSides sides(std::uint32_t point) const { return sides_[point]; }

    [[nodiscard]] std::vector<Point> take() { return std::move(points_); }

  private:
    Bounds box_;
    double tolerance_;
    std::vector<Point> points_;
    std::vector<BoxSides> sides_;
    std::multimap<std::int64_t, std::uint32_t> on_box_;  // by x, in tolerances
};

// Chains borders to loops; one that ends at the rim is led along it to where the next one begins.
// `own`: the side that the plane is itself, when it is one; only what lies on others, too, is on
// its rim. `is_full`: without any border the whole rim is a polygon. Nothing where a border ends
// and none goes on.
[[nodiscard]] std::optional<PlaneLoops> find_loops(
    PointTable& points,
    std::span<const PlaneEdge> edges,
    const Point& normal,
    const Rim& rim,
    BoxSides own,
    bool is_full
);

}  // namespace modelsynth::continuous
