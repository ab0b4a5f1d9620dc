#pragma once

#include "solver/registry/task.h"

#include <cstdint>

namespace modelsynth {

// What running a task takes, by its size and what it asks for, before any of it is done.
struct Estimate {
    std::uint64_t choices = 0;       // labels that are chosen, each as often as blocks cover it
    std::uint64_t memory_bytes = 0;  // at its peak, with the model as a GLB; rather too much
};

// Requires: defaults filled in. `model_count`: so many different models are made.
[[nodiscard]] Estimate estimate(const Task& task, std::uint32_t model_count = 1);

}  // namespace modelsynth
