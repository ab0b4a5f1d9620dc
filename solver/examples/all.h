#pragma once

#include "solver/registry/task.h"

#include <optional>
#include <string_view>
#include <vector>

namespace modelsynth::examples {

// The built-in examples of every solver, made and read on first use. Their names are their ids.
// Thread-safe.
[[nodiscard]] std::vector<Example> all();

[[nodiscard]] std::optional<Example> find(std::string_view name);

}  // namespace modelsynth::examples
