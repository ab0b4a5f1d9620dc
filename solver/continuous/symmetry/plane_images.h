#pragma once

#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/reading/topes.h"
#include "solver/continuous/symmetry/motion.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace modelsynth::continuous {

// Whether one of a family's planes lies within the tolerance of an offset.
[[nodiscard]] bool has_plane_at(const PlaneOffsets& planes, double offset, double tolerance);

// The family that a family's planes become, and whether its normal turns round.
struct FamilyImage {
    std::size_t family = 0;
    bool is_turned_round = false;
};

// Nothing where the example has no faces of that normal.
[[nodiscard]] std::optional<FamilyImage> family_image(
    const Topes& topes, std::size_t family, const Eigen::Matrix3d& turn
);

// Whether every family has an image.
[[nodiscard]] bool have_images(const Topes& topes, const Eigen::Matrix3d& turn);

// The first plane of a family, by offset, whose image is in the model and no plane of it.
// Shape: `planes` has the offsets of every family's planes, in rising order; `size` is the model's
// in metres. Requires: the family has an image.
[[nodiscard]] std::optional<double> plane_without_image(
    const Topes& topes,
    std::size_t family,
    const Motion& motion,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
);

}  // namespace modelsynth::continuous
