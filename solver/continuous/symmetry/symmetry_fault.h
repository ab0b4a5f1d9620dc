#pragma once

#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/symmetry/motion.h"

#include <array>
#include <optional>
#include <span>
#include <string>

namespace modelsynth::continuous {

// What is wrong with a symmetry.
struct SymmetryFault {
    std::string field;  // of the constraint, "/rotate"
    std::string detail;
};

// If anything is: faces without images, planes whose image lies between planes, objects whose
// images are no one-to-one map or do not come back.
// Shape: `planes` has the offsets of every family's planes. Requires: the objects are known.
[[nodiscard]] std::optional<SymmetryFault> find_symmetry_fault(
    const ExampleReading& reading,
    const SymmetryRule& rule,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
);

}  // namespace modelsynth::continuous
