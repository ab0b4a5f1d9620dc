#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/parameters.h"

#include <vector>

namespace modelsynth::discrete {

// A model made before that another one starts from: only a part is made anew, all else keeps its
// labels.
struct Origin {
    GridSize size;              // of that model
    std::vector<Label> labels;  // of that model, as Example::cells
    Cell at = {};               // of the model to make: where that model's corner lies
    // Of the model to make: what is made anew, besides the cells that the origin does not cover.
    // Without any box, cells, mask or voxels: nothing besides, or everything where the origin
    // covers all.
    Region remade = {};
};

}  // namespace modelsynth::discrete
