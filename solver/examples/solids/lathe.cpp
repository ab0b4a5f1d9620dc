#include "solver/examples/solids/lathe.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace modelsynth::examples {

using continuous::Face;
using continuous::Point;
using continuous::Shape;

std::shared_ptr<const Shape> lathe(
    std::span<const std::array<double, 2>> outline,
    std::uint32_t segments,
    const std::array<bool, 3>& is_even
) {
    auto shape = std::make_shared<Shape>();
    shape->is_even = is_even;
    // By place of the outline: the first corner of its ring, which is but one on the axis.
    std::vector<std::uint32_t> rings;
    for (const auto& [radius, height] : outline) {
        rings.push_back(static_cast<std::uint32_t>(shape->corners.size()));
        for (std::uint32_t i = 0; i < (radius > 0 ? segments : 1); ++i) {
            const double angle = 2 * std::numbers::pi * i / segments;
            shape->corners.emplace_back(
                radius * std::cos(angle), height, -radius * std::sin(angle)
            );
        }
    }
    for (std::size_t ring = 0; ring + 1 < outline.size(); ++ring) {
        const bool is_point_below = outline[ring][0] == 0;
        const bool is_point_above = outline[ring + 1][0] == 0;
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t next = (i + 1) % segments;
            Face face = {rings[ring] + (is_point_below ? 0 : i)};
            if (!is_point_below) {
                face.push_back(rings[ring] + next);
            }
            face.push_back(rings[ring + 1] + (is_point_above ? 0 : next));
            if (!is_point_above) {
                face.push_back(rings[ring + 1] + i);
            }
            shape->faces.push_back(std::move(face));
        }
    }
    return shape;
}

}  // namespace modelsynth::examples
