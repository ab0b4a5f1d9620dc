#pragma once

#include "solver/core/block_schedule.h"
#include "solver/core/grid.h"
#include "solver/core/search.h"
#include "solver/discrete/example.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::discrete {

// A list gives the weights of the pieces named; the others have weight 1.
using WeightList = std::vector<std::pair<std::string, double>>;
using Weights = std::variant<WeightRule, WeightList>;

// Blocks of Algorithm 3.4 and how often each is tried before it is taken back.
struct Blocks {
    BlockLayout layout;
    std::uint32_t attempts = 8;

    friend bool operator==(const Blocks&, const Blocks&) = default;
};

enum class ConstraintKind : std::uint8_t { kFixed, kForbidden };

// Cells that may take only these pieces (kFixed) or none of them (kForbidden). Without box and
// cells it holds everywhere; with both, in the cells of either.
struct Constraint {
    ConstraintKind kind = ConstraintKind::kFixed;
    std::vector<std::string> pieces;
    std::optional<Box> box;
    std::vector<Cell> cells;

    friend bool operator==(const Constraint&, const Constraint&) = default;
};

// What a discrete synthesis can be asked for; plain data, every field with a usable default once
// `fill_defaults` has run.
struct Parameters {
    std::optional<GridSize> size;  // none: the example's default
    // none: chosen to suit the size; a value without blocks: the whole at once.
    std::optional<std::optional<Blocks>> blocks;
    std::array<std::optional<SideBoundary>, kDirectionCount> boundary;  // none: the example's
    Order order = Order::kScan;
    std::optional<Weights> weights;  // none: the example's default
    std::vector<Constraint> constraints;

    friend bool operator==(const Parameters&, const Parameters&) = default;
};

// Attempts at the whole model where there are no blocks.
inline constexpr std::uint32_t kWholeAttempts = 20;

// The parameters with every default filled in from the example.
[[nodiscard]] Parameters fill_defaults(Parameters parameters, const Example& example);

}  // namespace modelsynth::discrete
