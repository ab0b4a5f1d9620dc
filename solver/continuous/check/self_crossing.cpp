#include "solver/continuous/check/self_crossing.h"

#include "solver/continuous/check/flat.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/triangulation/triangulation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// The border of a face in its plane.
class Border {
  public:
    Border(std::vector<Point2> points, double tolerance)
        : points_(std::move(points)), tolerance_(tolerance) {}

    // A place where the border crosses itself: this far along the edge from this corner.
    [[nodiscard]] std::optional<std::pair<std::size_t, double>> crossing() const {
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (turns_back(i)) {
                return std::pair(i, 0.0);
            }
        }
        // Edges side by side are in order of where they begin.
        std::vector<std::size_t> order(points_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(least(a), a) < std::pair(least(b), b);
        });
        for (auto edge = order.begin(); edge != order.end(); ++edge) {
            for (auto other = edge + 1; other != order.end() && least(*other) <= greatest(*edge);
                 ++other) {
                if (cross_inside(*edge, *other)) {
                    const double from = side_of(*edge, *other, next(*other));
                    const double to = side_of(next(*edge), *other, next(*other));
                    return std::pair(*edge, from / (from - to));
                }
                if (passes_through(*edge, *other)) {
                    return std::pair(*edge, 0.0);
                }
                if (passes_through(*other, *edge)) {
                    return std::pair(*other, 0.0);
                }
            }
        }
        return std::nullopt;
    }

  private:
    [[nodiscard]] std::size_t next(std::size_t i) const {
        return i + 1 < points_.size() ? i + 1 : 0;
    }

    [[nodiscard]] std::size_t previous(std::size_t i) const {
        return (i > 0 ? i : points_.size()) - 1;
    }

    [[nodiscard]] double least(std::size_t edge) const {
        return std::min(points_[edge][0], points_[next(edge)][0]);
    }

    [[nodiscard]] double greatest(std::size_t edge) const {
        return std::max(points_[edge][0], points_[next(edge)][0]);
    }

    // How far corner i is to the left of the line from corner a to corner b.
    [[nodiscard]] double side_of(std::size_t i, std::size_t a, std::size_t b) const {
        const Point2 along = minus(points_[b], points_[a]);
        const double length = std::sqrt(dot(along, along));
        const double side = length > 0 ? cross(along, minus(points_[i], points_[a])) / length : 0.0;
        return std::abs(side) <= tolerance_ ? 0 : side;
    }

    [[nodiscard]] bool turns_back(std::size_t i) const {
        const std::size_t a = previous(i);
        const std::size_t b = next(i);
        const Point2 in = minus(points_[i], points_[a]);
        const Point2 out = minus(points_[b], points_[i]);
        if (dot(in, out) >= 0) {
            return false;
        }
        return (dot(in, in) < dot(out, out) ? side_of(a, i, b) : side_of(b, a, i)) == 0;
    }

    // Whether two edges go through each other between their ends.
    [[nodiscard]] bool cross_inside(std::size_t edge, std::size_t other) const {
        const std::size_t edge_end = next(edge);
        const std::size_t other_end = next(other);
        return side_of(other, edge, edge_end) * side_of(other_end, edge, edge_end) < 0 &&
               side_of(edge, other, other_end) * side_of(edge_end, other, other_end) < 0;
    }

    // Whether the border goes through the edge at a corner between the edge's ends.
    [[nodiscard]] bool passes_through(std::size_t corner, std::size_t edge) const {
        const std::size_t end = next(edge);
        const Point2 along = minus(points_[end], points_[edge]);
        const double length = std::sqrt(dot(along, along));
        const double place = dot(along, minus(points_[corner], points_[edge]));
        return place > tolerance_ * length && place < (length - tolerance_) * length &&
               side_of(corner, edge, end) == 0 &&
               side_of(previous(corner), edge, end) * side_of(next(corner), edge, end) < 0;
    }

    std::vector<Point2> points_;
    double tolerance_;
};

}  // namespace

std::optional<Point> find_self_crossing(
    const Polyhedron& solid, const Face& face, double tolerance
) {
    Point normal = area_vector(solid, face);
    if (normal.norm() <= tolerance * tolerance) {
        // A border that crosses itself may have no area in all: a plane of any three corners.
        for (std::size_t i = 2; i < face.size() && normal.norm() <= tolerance * tolerance; ++i) {
            const Point a = solid.corners[face[i - 1]] - solid.corners[face[0]];
            normal = a.cross(solid.corners[face[i]] - solid.corners[face[0]]);
        }
    }
    std::vector<Point2> points;
    points.reserve(face.size());
    for (const std::uint32_t corner : face) {
        points.push_back(flattened(solid.corners[corner], normal));
    }
    const auto crossing = Border(std::move(points), tolerance).crossing();
    if (!crossing) {
        return std::nullopt;
    }
    const auto [edge, share] = *crossing;
    const Point& from = solid.corners[face[edge]];
    const Point& to = solid.corners[face[(edge + 1) % face.size()]];
    return from + share * (to - from);
}

}  // namespace modelsynth::continuous
