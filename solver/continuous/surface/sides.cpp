#include "solver/continuous/surface/sides.h"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace modelsynth::continuous {

namespace {

using Ends = std::pair<std::uint32_t, std::uint32_t>;

// How far the polygon of one side is turned from that of another one, through the inside.
double turn_between(const Side& side, const Side& other) {
    const double turn =
        std::atan2(-other.inwards.dot(side.outwards), other.inwards.dot(side.inwards));
    return turn > 1e-9 ? turn : turn + 2 * std::numbers::pi;
}

void pair_up(std::vector<Side>& sides) {
    std::map<Ends, std::vector<std::size_t>> by_ends;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        by_ends[{sides[s].from, sides[s].to}].push_back(s);
    }
    for (const auto& [ends, here] : by_ends) {
        const auto there = by_ends.find({ends.second, ends.first});
        if (ends.first > ends.second || there == by_ends.end()) {
            continue;
        }
        for (const std::size_t s : here) {
            std::size_t best = kNoSide;
            for (const std::size_t other : there->second) {
                const bool is_free = sides[other].twin == kNoSide;
                if (is_free && (best == kNoSide || turn_between(sides[s], sides[other]) <
                                                       turn_between(sides[s], sides[best]))) {
                    best = other;
                }
            }
            if (best != kNoSide) {
                sides[s].twin = best;
                sides[best].twin = s;
            }
        }
    }
}

}  // namespace

std::vector<Point> normals_of(const Surface& surface) {
    std::vector<Point> normals;
    normals.reserve(surface.polygons.size());
    for (const SurfacePolygon& polygon : surface.polygons) {
        const std::vector<std::uint32_t>& loop = polygon.loops.front();
        const Point& origin = surface.points[loop.front()];
        Point area = Point::Zero();
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            area += (surface.points[loop[i]] - origin).cross(surface.points[loop[i + 1]] - origin);
        }
        normals.push_back(area.normalized());
    }
    return normals;
}

std::vector<Side> sides_of(
    const Surface& surface, std::span<const Point> normals, ObjectId object
) {
    std::vector<Side> sides;
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        if (surface.polygons[p].object != object) {
            continue;
        }
        for (const std::vector<std::uint32_t>& loop : surface.polygons[p].loops) {
            const std::size_t first = sides.size();
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const std::size_t next = (i + 1) % loop.size();
                const Point along =
                    (surface.points[loop[next]] - surface.points[loop[i]]).normalized();
                sides.push_back(
                    {p,
                     loop[i],
                     loop[next],
                     first + next,
                     kNoSide,
                     normals[p].cross(along),
                     normals[p]}
                );
            }
        }
    }
    pair_up(sides);
    return sides;
}

}  // namespace modelsynth::continuous
