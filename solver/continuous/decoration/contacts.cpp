#include "solver/continuous/decoration/contacts.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

// Of what the places of a model are wrong by, a multiple; planes are ten times as far apart.
constexpr double kTolerance = 1e-9;  // of the model's extent

// Numbers of directions, of which opposite ones are the same.
class Directions {
  public:
    struct Direction {
        std::size_t number = 0;
        bool is_along = true;
    };

    Direction find_or_add(const Point& normal) {
        for (std::size_t i = 0; i < known_.size(); ++i) {
            if ((known_[i] - normal).squaredNorm() < 1e-16) {
                return {i, true};
            }
            if ((known_[i] + normal).squaredNorm() < 1e-16) {
                return {i, false};
            }
        }
        known_.push_back(normal);
        return {known_.size() - 1, true};
    }

    [[nodiscard]] const Point& at(std::size_t number) const { return known_[number]; }

  private:
    std::vector<Point> known_;
};

}  // namespace

Contacts::Contacts(const Surface& surface, std::span<const Point> normals)
    : surface_(surface), normals_(normals) {
    double extent = 0;
    for (const Point& point : surface.points) {
        extent = std::max(extent, point.cwiseAbs().maxCoeff());
    }
    tolerance_ = kTolerance * extent;
    for (const SurfacePolygon& polygon : surface.polygons) {
        Eigen::AlignedBox3d& box = boxes_.emplace_back();
        for (const std::uint32_t point : polygon.loops.front()) {
            box.extend(surface.points[point]);
        }
        box.min().array() -= tolerance_;
        box.max().array() += tolerance_;
    }
    find_planes();
}

void Contacts::find_planes() {
    Directions directions;
    std::vector<std::tuple<std::size_t, double, std::size_t>> by_plane;
    for (std::size_t p = 0; p < surface_.polygons.size(); ++p) {
        const auto [direction, is_along] = directions.find_or_add(normals_[p]);
        const Point& place = surface_.points[surface_.polygons[p].loops.front().front()];
        by_plane.emplace_back(direction, directions.at(direction).dot(place), p);
        is_along_.push_back(is_along ? 1 : 0);
    }
    std::sort(by_plane.begin(), by_plane.end());
    plane_of_.resize(surface_.polygons.size());
    std::vector<std::size_t> in_plane;
    for (std::size_t i = 0; i < by_plane.size(); ++i) {
        const auto& [direction, offset, p] = by_plane[i];
        if (i > 0 && (std::get<0>(by_plane[i - 1]) != direction ||
                      offset - std::get<1>(by_plane[i - 1]) > tolerance_)) {
            index_plane(in_plane);
            in_plane.clear();
        }
        in_plane.push_back(p);
        plane_of_[p] = planes_.size();
    }
    index_plane(in_plane);
}

void Contacts::index_plane(const std::vector<std::size_t>& polygons) {
    Plane& plane = planes_.emplace_back();
    Eigen::AlignedBox3d box;
    for (const std::size_t p : polygons) {
        box.extend(boxes_[p]);
    }
    box.sizes().maxCoeff(&plane.axis);
    std::array<std::vector<IntervalTree::Interval>, 2> intervals;
    for (const std::size_t p : polygons) {
        intervals.at(is_along_[p])
            .push_back({boxes_[p].min()[plane.axis], boxes_[p].max()[plane.axis], p});
    }
    for (std::size_t way = 0; way < 2; ++way) {
        plane.polygons.at(way) = IntervalTree(std::move(intervals.at(way)));
    }
}

std::vector<SidePart> Contacts::free_parts(const Side& side) const {
    const double length = (surface_.points[side.to] - surface_.points[side.from]).norm();
    Eigen::AlignedBox3d box(surface_.points[side.from]);
    box.extend(surface_.points[side.to]);
    const ObjectId object = surface_.polygons[side.polygon].object;
    std::vector<SidePart> covered;
    const Plane& plane = planes_[plane_of_[side.polygon]];
    const auto& across = plane.polygons.at(1U - is_along_[side.polygon]);
    across.for_each(box.min()[plane.axis], box.max()[plane.axis], [&](std::size_t p) {
        if (surface_.polygons[p].object != object && boxes_[p].intersects(box)) {
            cover(side, surface_.polygons[p], covered);
        }
    });
    std::sort(covered.begin(), covered.end(), [](const SidePart& a, const SidePart& b) {
        return std::tuple(a.begin, a.end) < std::tuple(b.begin, b.end);
    });
    std::vector<SidePart> free;
    double reached = 0;
    for (const SidePart& part : covered) {
        if (part.begin - reached > tolerance_) {
            free.push_back({reached, part.begin});
        }
        reached = std::max(reached, part.end);
    }
    if (length - reached > tolerance_) {
        free.push_back({reached, length});
    }
    return free;
}

// A line just inside of the side crosses the border of the other polygon: what is on the line
// itself counts as outside, so that borders along it need no rule of their own.
void Contacts::cover(
    const Side& side, const SurfacePolygon& polygon, std::vector<SidePart>& covered
) const {
    const Point& from = surface_.points[side.from];
    const Point& to = surface_.points[side.to];
    const double length = (to - from).norm();
    const Point along = (to - from) / length;
    std::vector<double> crossings;
    for (const std::vector<std::uint32_t>& loop : polygon.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point a = surface_.points[loop[i]] - from;
            const Point b = surface_.points[loop[(i + 1) % loop.size()]] - from;
            const double height_a = a.dot(side.inwards);
            const double height_b = b.dot(side.inwards);
            if ((height_a > tolerance_) != (height_b > tolerance_)) {
                const double share = std::clamp(height_a / (height_a - height_b), 0.0, 1.0);
                crossings.push_back(a.dot(along) + share * (b - a).dot(along));
            }
        }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const double begin = crossings[i] > tolerance_ ? crossings[i] : 0;
        const double end = crossings[i + 1] < length - tolerance_ ? crossings[i + 1] : length;
        if (end - begin > tolerance_) {
            covered.push_back({begin, end});
        }
    }
}

std::vector<SidePart> common_parts(const std::vector<SidePart>& a, const std::vector<SidePart>& b) {
    std::vector<SidePart> common;
    std::size_t i = 0;
    std::size_t k = 0;
    while (i < a.size() && k < b.size()) {
        const double begin = std::max(a[i].begin, b[k].begin);
        const double end = std::min(a[i].end, b[k].end);
        if (begin < end) {
            common.push_back({begin, end});
        }
        (a[i].end < b[k].end ? i : k) += 1;
    }
    return common;
}

}  // namespace modelsynth::continuous
