#pragma once

#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/problem.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::discrete {

// Something that a request asks for and could do without, with fewer models for it.
struct Cause {
    enum class Kind : std::uint8_t {
        kSide,        // what may stand on a side
        kConstraint,  // a constraint
        kOrigin,      // what is kept of the model that this one starts from
        kPeriodic,    // that an axis closes on itself
        kRemoved,     // that a piece has weight 0
    };

    Kind kind = Kind::kSide;
    std::size_t number = 0;  // of the side, the constraint, the axis (0 x, 1 y, 2 z), the piece

    friend bool operator==(const Cause&, const Cause&) = default;
};

// All causes of a request. Those that a person would rather hear of come first.
// Requires: the problem is that of the request.
[[nodiscard]] std::vector<Cause> find_causes(
    const Example& example, const Parameters& parameters, const Problem& problem
);

// The request with these causes and without all others, but for the origin, which is no parameter.
// Whether there is a model is then a question of the example, the size and the causes alone.
[[nodiscard]] Parameters with_causes(
    const Example& example, const Parameters& parameters, std::span<const Cause> causes
);

// "constraint 2 (count of "tower" and "gate")", "the bottom side": as a person reads it.
[[nodiscard]] std::string name_cause(
    const Example& example, const Parameters& parameters, const Cause& cause
);

}  // namespace modelsynth::discrete
