#pragma once

#include "solver/continuous/problem.h"

#include <cstddef>
#include <string>
#include <vector>

namespace modelsynth::continuous {

inline constexpr std::size_t kWarningsMax = 20;

// What of a request cannot be had, for people: figures that no point of the model has the planes
// for, those that a symmetry asks images of that the example does not have, and spacings that do
// not fit each other. One sentence each, at most kWarningsMax, of which
// the last one then says how many are left out.
[[nodiscard]] std::vector<std::string> warnings_of(const Problem& problem);

}  // namespace modelsynth::continuous
