#pragma once

#include "solver/continuous/example.h"

#include <memory>
#include <vector>

namespace modelsynth::examples {

// The vocabulary of decorations.

inline constexpr continuous::FaceChoice kUp = {continuous::FaceKind::kUp};
inline constexpr continuous::FaceChoice kSide = {continuous::FaceKind::kSide};
inline constexpr continuous::FaceChoice kSlope = {continuous::FaceKind::kSlope};

// Along all edges that turn outwards, of the material of object `look`.
[[nodiscard]] continuous::Decoration moulding(
    const continuous::FaceChoice& first,
    const continuous::FaceChoice& second,
    std::vector<continuous::ProfilePoint> profile,
    continuous::ObjectId look
);

// A bar along an edge that shows by so much out of either face, and is as wide on each of them.
[[nodiscard]] std::vector<continuous::ProfilePoint> bar(double out, double width);

// A pointed ball on a neck: so high, and half as wide. Its foot is a little below its origin.
[[nodiscard]] std::shared_ptr<const continuous::Shape> finial(double height);

}  // namespace modelsynth::examples
