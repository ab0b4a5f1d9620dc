#pragma once

#include "solver/continuous/surface/surface.h"
#include "tests/support/polygon_set.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace modelsynth::testing {

// The polygons of a surface as a set whose solids are object types.
// `box`: what the model may fill.
[[nodiscard]] PolygonSet solids_of(
    const continuous::Surface& surface, std::size_t object_types, const Eigen::AlignedBox3d& box
);

// A model of solids, asked what is where: by its polygons alone, with none of the solver's labels.
class SolidPlaces {
  public:
    // `box`: what the model may fill.
    SolidPlaces(
        const continuous::Surface& surface, std::size_t object_types, const Eigen::AlignedBox3d& box
    );

    // What fills space there. Requires: the point is on no polygon.
    [[nodiscard]] ObjectId at(const Point& point) const;

    // In how many pieces these objects come, all together; what touches at a point is one piece.
    // The border of a hollow, which encloses no more than it leaves out, is no piece of its own.
    // Cost: O(polygons^2) at worst.
    [[nodiscard]] std::size_t pieces(const std::vector<ObjectId>& objects) const;

    [[nodiscard]] const PolygonSet& set() const { return set_; }

  private:
    PolygonSet set_;
};

}  // namespace modelsynth::testing
