#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/example.h"
#include "solver/mesh/scene.h"

#include <span>

namespace modelsynth::discrete {

// The labels of `region` as a scene, a piece at each cell that is drawn, in groups of 16 by 16
// columns. Frame: the whole model's, its corner of least x, y, z in the origin. Cells with
// kNoLabel are not drawn.
// Shape: labels has a label for every cell of `size`.
[[nodiscard]] Scene make_scene(
    const Example& example, const GridSize& size, std::span<const Label> labels, const Box& region
);

// One piece of each kind that is drawn, side by side, a group per piece named as it.
[[nodiscard]] Scene make_piece_sheet(const Example& example);

}  // namespace modelsynth::discrete
