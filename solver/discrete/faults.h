#pragma once

#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <string>
#include <vector>

namespace modelsynth::discrete {

// Everything wrong with parameters that are well-formed by themselves, against this example:
// unknown pieces, cells outside the model, sides that cannot go together. Pointers are relative
// to `parameters`. Empty: nothing wrong.
// Requires: defaults filled in.
[[nodiscard]] std::vector<Fault> find_faults(const Example& example, const Parameters& parameters);

// What of a region lies outside a model; `pointer` is the place of the object that has its fields.
void find_region_faults(
    const Region& region,
    const GridSize& size,
    const std::string& pointer,
    std::vector<Fault>& faults
);

}  // namespace modelsynth::discrete
