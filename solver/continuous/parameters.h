#pragma once

#include "solver/continuous/constraints.h"
#include "solver/core/block_schedule.h"
#include "solver/core/grid.h"
#include "solver/core/result.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// What a continuous synthesis can be asked for; plain data.
struct Parameters {
    std::optional<std::array<double, 3>> size;  // metres; none: the example's default
    std::optional<double> spacing;              // metres; none: the example's
    // In spacings. None: chosen to suit the size; a value without blocks: the whole at once.
    std::optional<std::optional<Blocks>> blocks;
    // 0 ... 1: how full the model is to be. What is empty space or bare ground has the weight
    // density^-2 against all else. None: the example's.
    std::optional<double> density;
    // Weights of figures by the object types in them; those not named have the example's.
    std::vector<std::pair<std::string, double>> weights;
    // None: the example's. Of a kind that none of them is of, those of the example hold, too; no
    // constraint at all: none whatever.
    std::optional<std::vector<Constraint>> constraints;

    friend bool operator==(const Parameters&, const Parameters&) = default;
};

inline constexpr std::int32_t kCellsAlongMax = 4096;

struct Example;

// The parameters with every default filled in from the example.
[[nodiscard]] Parameters fill_defaults(Parameters parameters, const Example& example);

// The model's size in spacings, cut ones counted whole. Requires: defaults filled in.
[[nodiscard]] GridSize cells_of(const Parameters& parameters);

}  // namespace modelsynth::continuous
