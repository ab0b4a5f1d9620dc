#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/example.h"

#include <array>

namespace modelsynth::continuous {

// How much of a region a place belongs to, 0 ... 1: a box counts as 1, its border included, a mask
// or voxels give the value of their cell. Of several the most. Below y = 0 there is no region.
// Thread-safe. Requires: the region outlives it.
class Coverage {
  public:
    Coverage(const Region& region, const std::array<double, 3>& size);

    [[nodiscard]] double at(const Point& place) const;

    // Whether it is the same everywhere within reach of a place. May be false where it is. O(1) as
    // long as the reach is no more than some cells of masks and voxels.
    [[nodiscard]] bool is_uniform(const Point& place, double reach) const;

  private:
    struct Range {
        double least = 1;
        double most = 0;

        void add(double value);
    };

    [[nodiscard]] Range range(const Point& low, const Point& high) const;

    const Region& region_;
    std::array<double, 3> size_;
    bool is_everywhere_;
};

}  // namespace modelsynth::continuous
