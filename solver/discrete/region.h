#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/parameters.h"

#include <cstdint>
#include <vector>

namespace modelsynth::discrete {

// How much of a region a cell of a model belongs to, 0 ... 1: whole cells of boxes and lists count
// as 1, a mask or voxels give the value of their cell that holds this cell's middle. Of several the
// most.
// Cost: O(1). Thread-safe. Requires: the region outlives it.
class RegionCoverage {
  public:
    RegionCoverage(const Region& region, const GridSize& model);

    [[nodiscard]] double at(const Cell& cell) const;

    // Whether the region holds the cell, when it has to be one or the other.
    [[nodiscard]] bool contains(const Cell& cell) const { return at(cell) >= 0.5; }

    [[nodiscard]] bool is_everywhere() const { return is_everywhere_; }

  private:
    const Region& region_;
    GridSize model_;
    bool is_everywhere_;
    std::vector<std::uint8_t> listed_;  // by cell of the model; empty: none is listed
};

}  // namespace modelsynth::discrete
