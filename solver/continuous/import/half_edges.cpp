#include "solver/continuous/import/half_edges.h"

#include "solver/core/disjoint_sets.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr std::size_t kTrianglesAtEdgeMax = 32;

// Nothing is so thin (radians): triangles at such an angle lie on each other, and the solid is all
// the way round.
constexpr double kThinnest = 1e-4;

struct Side {
    std::uint32_t low = 0;  // the edge's ends
    std::uint32_t high = 0;
    HalfEdge half = 0;
    bool is_forth = false;  // from low to high

    [[nodiscard]] bool is_beside(const Side& other) const {
        return low == other.low && high == other.high;
    }
};

std::vector<Side> sides_of(std::span<const Triangle> triangles) {
    std::vector<Side> sides;
    sides.reserve(triangles.size() * 3);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t from = triangles[t][c];
            const std::uint32_t to = triangles[t][(c + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), 3 * t + c, from < to});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tuple(a.low, a.high, a.half) < std::tuple(b.low, b.high, b.half);
    });
    return sides;
}

// Matches the sides of one edge at which solids touch: from a triangle that runs forth one turns
// through its solid, clockwise about the edge, to the first that runs back.
void match(
    std::span<const Side> sides,
    std::span<const Point> points,
    std::span<const Triangle> triangles,
    std::vector<HalfEdge>& mates
) {
    const Point& origin = points[sides.front().low];
    const Point along = (points[sides.front().high] - origin).normalized();
    const Point right = along.unitOrthogonal();
    const Point up = along.cross(right);
    const auto angle_of = [&](const Side& side) {
        const Point far = points[triangles[side.half / 3][(side.half + 2) % 3]] - origin;
        return std::atan2(far.dot(up), far.dot(right));
    };
    std::vector<std::tuple<double, HalfEdge, HalfEdge>> pairs;
    for (const Side& forth : sides) {
        for (const Side& back : sides) {
            if (!forth.is_forth || back.is_forth) {
                continue;
            }
            double angle = angle_of(forth) - angle_of(back);
            while (angle < kThinnest) {
                angle += 2 * std::numbers::pi;
            }
            pairs.emplace_back(angle, forth.half, back.half);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [angle, forth, back] : pairs) {
        if (mates[forth] == kNoHalfEdge && mates[back] == kNoHalfEdge) {
            mates[forth] = back;
            mates[back] = forth;
        }
    }
}

}  // namespace

std::vector<HalfEdge> find_mates(
    std::span<const Point> points, std::span<const Triangle> triangles
) {
    std::vector<HalfEdge> mates(triangles.size() * 3, kNoHalfEdge);
    const std::vector<Side> sides = sides_of(triangles);
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
        for (end = first; end < sides.size() && sides[end].is_beside(sides[first]);) {
            ++end;
        }
        const std::span<const Side> edge(sides.data() + first, end - first);
        if (edge.size() == 2 && edge[0].is_forth != edge[1].is_forth) {
            mates[edge[0].half] = edge[1].half;
            mates[edge[1].half] = edge[0].half;
        } else if (edge.size() > 2 && edge.size() <= kTrianglesAtEdgeMax) {
            match(edge, points, triangles, mates);
        }
    }
    return mates;
}

std::vector<std::uint32_t> corners_of(std::span<const HalfEdge> mates) {
    DisjointSets corners(mates.size());
    for (HalfEdge half = 0; half < mates.size(); ++half) {
        corners.join(half, next_in_triangle(mates[half]));
    }
    std::vector<std::uint32_t> numbers(mates.size());
    for (HalfEdge half = 0; half < mates.size(); ++half) {
        numbers[half] = corners.find(half);
    }
    return numbers;
}

}  // namespace modelsynth::continuous
