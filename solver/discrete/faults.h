#pragma once

#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <vector>

namespace modelsynth::discrete {

// Everything wrong with parameters that are well-formed by themselves, against this example:
// unknown pieces, cells outside the model, sides that cannot go together. Pointers are relative
// to `parameters`. Empty: nothing wrong.
// Requires: defaults filled in.
[[nodiscard]] std::vector<Fault> find_faults(const Example& example, const Parameters& parameters);

}  // namespace modelsynth::discrete
