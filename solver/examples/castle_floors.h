#pragma once

#include "solver/examples/example_builder.h"

namespace modelsynth::examples::castle {

// The example's floors, from the ground up; castle.cpp says which letter is which piece.
void add_floors(ExampleBuilder& builder);

}  // namespace modelsynth::examples::castle
