#pragma once

#include "solver/continuous/parameters.h"
#include "solver/core/result.h"

#include <vector>

namespace modelsynth::continuous {

class ExampleReading;

// What cannot be done of them; pointers are relative to the parameters. Requires: defaults filled
// in.
[[nodiscard]] std::vector<Fault> find_faults(
    const ExampleReading& reading, const Parameters& parameters
);

}  // namespace modelsynth::continuous
