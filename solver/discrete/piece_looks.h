#pragma once

#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <array>
#include <vector>

namespace modelsynth::discrete {

// The rough shape of a piece as it stands in its cell: where the corners of its mesh reach and how
// they lie about, enough to tell a cottage from a tower and its front from its back.
// Units: the wider side of a cell.
struct PieceLook {
    bool is_drawn = false;
    std::array<float, 3> min = {};
    std::array<float, 3> max = {};
    std::array<float, 3> mean = {};    // of the corners
    std::array<float, 3> square = {};  // the mean of x^2, y^2, z^2
    float product = 0;                 // the mean of x z
};

// Shape: by label. Cost: O(corners of the kit + pieces).
[[nodiscard]] std::vector<PieceLook> piece_looks(const Example& example);

// What a motion makes of it.
[[nodiscard]] PieceLook moved(const PieceLook& look, Symmetry::Kind kind);

// The largest difference of any of its numbers; infinite if only one of the two is drawn.
[[nodiscard]] float difference(const PieceLook& a, const PieceLook& b);

}  // namespace modelsynth::discrete
