#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/reading/families.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace modelsynth::continuous {

// A rigid motion of a model onto itself: p goes to turn * p + shift.
struct Motion {
    Eigen::Matrix3d turn;  // a signed permutation of the axes that leaves y
    Point shift;           // metres
};

// Shape: `size` of the model in metres.
[[nodiscard]] Motion motion_of(const SymmetryRule& rule, const std::array<double, 3>& size);

// How often a reflection or turn has to be made until all is as before; 0: never.
[[nodiscard]] std::size_t order_of(SymmetryRule::Kind kind);

}  // namespace modelsynth::continuous
