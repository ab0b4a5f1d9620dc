#pragma once

#include "solver/continuous/example.h"
#include "solver/core/block_schedule.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

struct Blocks {
    BlockLayout layout;  // in spacings
    std::uint32_t attempts = 8;

    friend bool operator==(const Blocks&, const Blocks&) = default;
};

// What a continuous synthesis can be asked for; plain data.
struct Parameters {
    std::optional<std::array<double, 3>> size;    // metres; none: the example's default
    std::optional<double> spacing;                // metres; none: the example's
    std::optional<std::optional<Blocks>> blocks;  // a value without blocks: the whole at once
    // 0 ... 1: how full the model is to be. What is empty space or bare ground has the weight
    // density^-2 against all else. None: the example's.
    std::optional<double> density;
    // Weights of figures by the object types in them; those not named have the example's.
    std::vector<std::pair<std::string, double>> weights;

    friend bool operator==(const Parameters&, const Parameters&) = default;
};

}  // namespace modelsynth::continuous
