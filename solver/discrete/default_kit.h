#pragma once

#include "solver/discrete/example.h"

namespace modelsynth::discrete {

// Gives every piece that should be seen and has no mesh a box of its own colour, so that labels
// alone are enough to start. The example's `empty` piece, and pieces called air, empty, nothing,
// sky or void, stay undrawn.
void add_missing_meshes(Example& example);

}  // namespace modelsynth::discrete
