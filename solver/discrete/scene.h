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

// One piece of each kind, side by side; pieces that draw nothing have a place all the same. For
// GlbOptions::named_nodes and profile kNodes.
[[nodiscard]] Scene make_piece_sheet(const Example& example);

}  // namespace modelsynth::discrete
