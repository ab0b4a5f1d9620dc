#pragma once

#include "solver/registry/task.h"

#include <string>

namespace modelsynth::proto {

// The resource /v1/examples/{id}/analysis.
[[nodiscard]] std::string analysis_json(
    const Example& example, const std::string& id, const Analysis& analysis
);

// The resource /v1/examples/{id}/success.svg.
[[nodiscard]] std::string success_drawing(const Example& example, const Analysis& analysis);

}  // namespace modelsynth::proto
