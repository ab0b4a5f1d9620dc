#pragma once

#include "solver/continuous/example.h"

#include <span>

namespace modelsynth::continuous {

// Whether a face that looks that way (unit length) is one of those that are meant.
[[nodiscard]] bool is_chosen(const FaceChoice& choice, const Point& normal);

// Whether for each choice there is another one of the faces.
[[nodiscard]] bool are_chosen(std::span<const FaceChoice> choices, std::span<const Point> normals);

}  // namespace modelsynth::continuous
