#pragma once

#include "solver/continuous/example.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace modelsynth::testing {

using continuous::ObjectId;
using continuous::Point;
using SpaceLoop = std::vector<Point>;

// A flat part of a solid's border; what it encloses is to the left of its loops, seen from outside.
struct SpacePolygon {
    std::size_t solid = 0;
    std::vector<SpaceLoop> loops;
    Point normal;       // of unit length, out of the solid, by the loops alone
    double offset = 0;  // mean of normal . corner
    double area = 0;
    Eigen::AlignedBox3d box;
};

[[nodiscard]] SpacePolygon make_space_polygon(std::size_t solid, std::vector<SpaceLoop> loops);

// How often the loops go round the point where both are seen along an axis, against that axis; none
// if the point comes nearer than `near` to a loop.
[[nodiscard]] std::optional<int> turns_round(
    const SpacePolygon& polygon, const Point& point, int axis, double near = -1
);

// Whether the polygon covers the point's foot in its plane.
[[nodiscard]] bool covers(const SpacePolygon& polygon, const Point& point);

[[nodiscard]] double distance(const SpacePolygon& polygon, const Point& point);

// The solid angle under which the polygon is seen, positive from the inside.
[[nodiscard]] double solid_angle(const SpacePolygon& polygon, const Point& point);

// What there is near a point.
struct Surroundings {
    std::vector<std::uint32_t> through;  // polygons that the point is on
    double gap = 0;                      // distance to the nearest other one, at most the reach
};

// Solids given by their borders, for questions about places: the common ground on which an example
// and a model are looked at. Thread-safe.
class PolygonSet {
  public:
    struct Frame {
        Eigen::AlignedBox3d clip;  // what is strictly inside counts
        double tolerance = 1e-7;   // what is nearer is in the same place, metres
        double reach = 1;          // gaps are no larger
    };

    // `objects`: of every solid; the polygons' solids are numbers into it.
    PolygonSet(std::vector<SpacePolygon> polygons, std::vector<ObjectId> objects, Frame frame);

    [[nodiscard]] const std::vector<SpacePolygon>& polygons() const { return polygons_; }

    [[nodiscard]] const std::vector<ObjectId>& objects() const { return objects_; }

    [[nodiscard]] const Frame& frame() const { return frame_; }

    // Whether the point is inside the clip by more than the tolerance.
    [[nodiscard]] bool is_inside_clip(const Point& point) const;

    [[nodiscard]] Surroundings surroundings(const Point& point) const;

    // By solid, how often its border goes round the point: by the crossings of a ray upwards or,
    // where that is not safe, by solid angles. Requires: the point is on no polygon.
    [[nodiscard]] std::vector<int> windings(const Point& point) const;

    // The same by solid angles, not rounded.
    [[nodiscard]] std::vector<double> exact_windings(const Point& point) const;

  private:
    [[nodiscard]] const std::vector<std::uint32_t>& column(const Point& point) const;

    static constexpr int kColumns = 32;

    std::vector<SpacePolygon> polygons_;
    std::vector<ObjectId> objects_;
    Frame frame_;
    Eigen::AlignedBox3d extent_;
    // Polygons that may be above or below a square of the ground.
    std::array<std::vector<std::uint32_t>, std::size_t{kColumns} * kColumns> columns_;
};

}  // namespace modelsynth::testing
