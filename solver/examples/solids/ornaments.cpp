#include "solver/examples/solids/ornaments.h"

#include "solver/examples/solids/lathe.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

using continuous::Decoration;
using continuous::EdgeDecoration;
using continuous::FaceChoice;
using continuous::ObjectId;
using continuous::ProfilePoint;
using continuous::Shape;
using continuous::Turn;

Decoration moulding(
    const FaceChoice& first,
    const FaceChoice& second,
    std::vector<ProfilePoint> profile,
    ObjectId look
) {
    return EdgeDecoration{{first, second}, Turn::kConvex, std::move(profile), look};
}

// What is within the object is not seen: three corners do.
std::vector<ProfilePoint> bar(double out, double width) {
    return {{out, out}, {-width, out}, {out, -width}};
}

std::shared_ptr<const Shape> finial(double height) {
    constexpr std::uint32_t kSegments = 6;
    constexpr std::array<std::array<double, 2>, 6> kOutline = {
        {{0, -0.08}, {0.15, -0.08}, {0.09, 0.1}, {0.25, 0.35}, {0.07, 0.65}, {0, 1}}};
    std::array<std::array<double, 2>, kOutline.size()> outline = kOutline;
    for (auto& [radius, level] : outline) {
        radius *= height;
        level *= height;
    }
    return lathe(outline, kSegments, {});
}

}  // namespace modelsynth::examples
