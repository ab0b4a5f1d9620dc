#pragma once

#include "solver/discrete/example.h"

#include <memory>
#include <vector>

namespace modelsynth::examples {

// The built-in example models, made on first use and kept. Their names are their ids.
// Thread-safe.
[[nodiscard]] const std::vector<std::shared_ptr<const discrete::Example>>& built_in();

// Each of them, made anew.
[[nodiscard]] discrete::Example make_castle();
[[nodiscard]] discrete::Example make_city();
[[nodiscard]] discrete::Example make_canyon();

}  // namespace modelsynth::examples
