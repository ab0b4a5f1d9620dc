#pragma once

#include "solver/continuous/example.h"

#include <array>
#include <memory>
#include <span>

namespace modelsynth::examples {

// A shape turned about the y axis: an outline of (radius, height) from the axis below to the axis
// above. The largest radius fills the box of the shape.
[[nodiscard]] std::shared_ptr<const continuous::Shape> lathe(
    std::span<const std::array<double, 2>> outline,
    std::uint32_t segments,
    const std::array<bool, 3>& is_even
);

}  // namespace modelsynth::examples
