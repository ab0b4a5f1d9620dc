#pragma once

#include "solver/continuous/decoration/interval_tree.h"
#include "solver/continuous/surface/sides.h"
#include "solver/continuous/surface/surface.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A part of a side, metres from where it begins.
struct SidePart {
    double begin = 0;
    double end = 0;
};

// Where objects lie against each other. A polygon of an object goes on behind other objects, so
// that what lies against it are polygons of others, in its plane, that look the other way.
// The surface and the normals are referred to.
class Contacts {
  public:
    // Normals: unit length, by polygon; those of parallel planes the same up to rounding.
    Contacts(const Surface& surface, std::span<const Point> normals);

    // The parts of a side along which its polygon, seen from it inwards, borders empty space:
    // ascending, apart from each other, whole up to its ends where they come near to these.
    // Cost: O(log n) for n polygons in the plane, and the corners of those beside the side.
    [[nodiscard]] std::vector<SidePart> free_parts(const Side& side) const;

    // Below this (metres) places are one.
    [[nodiscard]] double tolerance() const { return tolerance_; }

  private:
    // Its polygons against its first normal and along it, by where they lie along its longest axis.
    struct Plane {
        Eigen::Index axis = 0;
        std::array<IntervalTree, 2> polygons;
    };

    void find_planes();
    void index_plane(const std::vector<std::size_t>& polygons);
    // Adds from where to where a polygon lies on a side.
    void cover(const Side& side, const SurfacePolygon& polygon, std::vector<SidePart>& covered)
        const;

    const Surface& surface_;
    std::span<const Point> normals_;
    double tolerance_ = 0;
    std::vector<Plane> planes_;
    std::vector<std::size_t> plane_of_;       // by polygon
    std::vector<std::uint8_t> is_along_;      // by polygon: which list of its plane
    std::vector<Eigen::AlignedBox3d> boxes_;  // by polygon
};

// What two sets of parts have in common.
[[nodiscard]] std::vector<SidePart> common_parts(
    const std::vector<SidePart>& a, const std::vector<SidePart>& b
);

}  // namespace modelsynth::continuous
