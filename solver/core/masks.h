#pragma once

#include "solver/core/grid.h"

#include <cstdint>
#include <string>
#include <vector>

namespace modelsynth {

// Grey values over x (west to east) and z (north to south), stretched over a model: 0 nothing,
// 1 all. From an image, whose text is kept so that it can be told again.
struct Mask {
    std::int32_t width = 0;
    std::int32_t depth = 0;
    std::vector<std::uint8_t> values;  // row by row from the north, 255 is all
    std::string source;

    friend bool operator==(const Mask&, const Mask&) = default;
};

// Values 0 ... 1 on a grid of its own that is stretched over a model, in the order of flat arrays
// of cells.
struct Voxels {
    GridSize size;
    std::vector<double> values;

    friend bool operator==(const Voxels&, const Voxels&) = default;
};

}  // namespace modelsynth
