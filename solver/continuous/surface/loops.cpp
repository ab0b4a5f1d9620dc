#include "solver/continuous/surface/loops.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace modelsynth::continuous {

namespace {

constexpr double kSamePlace = 1e-8;  // of the box's extent

using Loop = std::vector<std::uint32_t>;

double area_of(const PointTable& points, const Loop& loop, const Point& normal) {
    Point sum = Point::Zero();
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        const Point a = points.at(loop[i]) - points.at(loop[0]);
        const Point b = points.at(loop[i + 1]) - points.at(loop[0]);
        sum += a.cross(b) / 2;
    }
    return sum.dot(normal);
}

bool surrounds(
    const PointTable& points, const Loop& loop, const Point& probe, const Point& normal
) {
    const Point right = normal.unitOrthogonal();
    const Point up = normal.cross(right);
    bool is_inside = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point a = points.at(loop[i]) - probe;
        const Point b = points.at(loop[(i + 1) % loop.size()]) - probe;
        const double ay = a.dot(up);
        const double by = b.dot(up);
        if ((ay > 0) != (by > 0)) {
            const double ax = a.dot(right);
            const double bx = b.dot(right);
            is_inside = is_inside != (ax + (bx - ax) * ay / (ay - by) > 0);
        }
    }
    return is_inside;
}

// Borders enclose nothing together.
struct Inconsistent {};

void require(bool condition) {
    if (!condition) {
        throw Inconsistent();
    }
}

class LoopFinder {
  public:
    LoopFinder(
        PointTable& points,
        std::span<const PlaneEdge> edges,
        const Point& normal,
        const Rim& rim,
        BoxSides own
    )
        : points_(points),
          edges_(edges.begin(), edges.end()),
          normal_(normal),
          given_rim_(rim),
          own_(own) {
        std::sort(edges_.begin(), edges_.end(), [](const PlaneEdge& a, const PlaneEdge& b) {
            return std::pair(a.from, a.to) < std::pair(b.from, b.to);
        });
    }

    PlaneLoops find(bool is_full) && {
        order_ends();
        is_used_.assign(edges_.size(), 0);
        for (std::size_t start = 0; start < edges_.size(); ++start) {
            if (is_used_[start] == 0) {
                add_loop(start);
            }
        }
        if (ends_.empty() && (edges_.empty() ? is_full : is_within_holes())) {
            make_rim();
            Loop loop;
            walk_rim(loop);
            outers_.push_back(std::move(loop));
        }
        for (Loop& outer : outers_) {
            made_.polygons.push_back({std::move(outer)});
        }
        for (Loop& hole : holes_) {
            put_into_polygon(std::move(hole));
        }
        return std::move(made_);
    }

  private:
    // Where a border meets the rim.
    struct End {
        std::size_t edge = 0;
        bool is_begin = false;
        double along = 0;  // corners of the rim passed, and what share of the way to the next one
        double angle = 0;  // from the rim as it goes on to the border: the less, the farther ahead
    };

    [[nodiscard]] bool is_on_rim(std::uint32_t point) const {
        return (points_.sides(point) & ~own_) != 0;
    }

    // Its corners become points only where something ends at it.
    void make_rim() {
        if (rim_.empty()) {
            for (const Point& corner : given_rim_.corners) {
                rim_.push_back(points_.on_box(corner));
            }
        }
    }

    // What a border encloses goes on along the rim, counter-clockwise, from where it ends to where
    // the next one begins.
    void order_ends() {
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            for (const bool is_begin : {true, false}) {
                const std::uint32_t here = is_begin ? edges_[e].from : edges_[e].to;
                if (is_on_rim(here)) {
                    make_rim();
                    const std::uint32_t there = is_begin ? edges_[e].to : edges_[e].from;
                    ends_.push_back(end_at(e, is_begin, points_.at(there) - points_.at(here)));
                }
            }
        }
        std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) {
            return a.along < b.along;
        });
        const double same = 1e-9 * static_cast<double>(rim_.size());
        for (std::size_t first = 0; first < ends_.size();) {
            std::size_t last = first + 1;
            while (last < ends_.size() && ends_[last].along - ends_[last - 1].along <= same) {
                ++last;
            }
            std::sort(
                ends_.begin() + static_cast<std::ptrdiff_t>(first),
                ends_.begin() + static_cast<std::ptrdiff_t>(last),
                [](const End& a, const End& b) { return a.angle > b.angle; }
            );
            first = last;
        }
        number_of_end_.assign(edges_.size(), 0);
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            if (!ends_[i].is_begin) {
                number_of_end_[ends_[i].edge] = i;
            }
        }
    }

    [[nodiscard]] End end_at(std::size_t edge, bool is_begin, const Point& inwards) const {
        const std::uint32_t point = is_begin ? edges_[edge].from : edges_[edge].to;
        End end = {edge, is_begin, 0, 0};
        double nearest = std::numeric_limits<double>::infinity();
        Point ahead = Point::Zero();
        for (std::size_t i = 0; i < rim_.size(); ++i) {
            const Point& a = points_.at(rim_[i]);
            const Point way = points_.at(rim_[(i + 1) % rim_.size()]) - a;
            const double length = way.squaredNorm();
            if (length == 0) {
                continue;
            }
            double share = std::clamp((points_.at(point) - a).dot(way) / length, 0.0, 1.0);
            share = share < 1e-9 ? 0 : share > 1 - 1e-9 ? 1 : share;
            const double away = (a + share * way - points_.at(point)).norm();
            // Of two pieces that meet there the later one, along which it goes on.
            if (share < 1 && away < nearest - 1e-12) {
                nearest = away;
                end.along = static_cast<double>(i) + share;
                ahead = way;
            }
        }
        end.angle = std::atan2(ahead.cross(inwards).dot(normal_), ahead.dot(inwards));
        return end;
    }

    void add_loop(std::size_t start) {
        Loop loop;
        std::size_t at = start;
        do {
            is_used_[at] = 1;
            if (edges_[at].is_from_corner) {
                loop.push_back(edges_[at].from);
            }
            at = is_on_rim(edges_[at].to) ? next_along_rim(at, start, loop) : next_of(at, start);
        } while (at != start);
        (area_of(points_, loop, normal_) > 0 ? outers_ : holes_).push_back(std::move(loop));
    }

    std::size_t next_along_rim(std::size_t at, std::size_t start, Loop& loop) {
        const std::size_t end = number_of_end_[at];
        const std::size_t next = (end + 1) % ends_.size();
        const std::size_t edge = ends_[next].edge;
        require(ends_[next].is_begin && (is_used_[edge] == 0 || edge == start));
        const std::uint32_t from = edges_[at].to;
        const std::uint32_t to = edges_[edge].from;
        const bool is_round = next <= end;
        if (from != to || is_round) {
            loop.push_back(from);
            const auto first = static_cast<std::size_t>(ends_[end].along);
            const auto last = static_cast<std::size_t>(ends_[next].along);
            std::uint32_t before = from;
            std::size_t i = first;
            const std::size_t steps = (last + rim_.size() - first) % rim_.size() +
                                      (is_round && last == first ? rim_.size() : 0);
            for (std::size_t step = 0; step < steps; ++step) {
                const std::uint32_t corner = rim_[(i + 1) % rim_.size()];
                if (corner != before && corner != to) {
                    loop.push_back(corner);
                    add_piece(before, corner, i);
                    before = corner;
                }
                i = (i + 1) % rim_.size();
            }
            add_piece(before, to, i);
        }
        return edge;
    }

    // All corners of the rim, each once.
    void walk_rim(Loop& loop) {
        for (std::size_t i = 0; i < rim_.size(); ++i) {
            if (rim_[i] != rim_[(i + 1) % rim_.size()]) {
                loop.push_back(rim_[i]);
                add_piece(rim_[i], rim_[(i + 1) % rim_.size()], i);
            }
        }
    }

    void add_piece(std::uint32_t from, std::uint32_t to, std::size_t number) {
        made_.pieces.push_back({from, to, given_rim_.sides[number]});
    }

    // Where several borders meet in a point, the one that keeps the polygon on the left simple.
    [[nodiscard]] std::size_t next_of(std::size_t at, std::size_t start) const {
        const std::uint32_t point = edges_[at].to;
        auto candidate = std::lower_bound(
            edges_.begin(),
            edges_.end(),
            point,
            [](const PlaneEdge& edge, std::uint32_t from) { return edge.from < from; }
        );
        auto best = edges_.end();
        double least = 0;
        const Point back = points_.at(edges_[at].from) - points_.at(point);
        for (; candidate != edges_.end() && candidate->from == point; ++candidate) {
            const auto number = static_cast<std::size_t>(candidate - edges_.begin());
            if (is_used_[number] != 0 && number != start) {
                continue;
            }
            const Point out = points_.at(candidate->to) - points_.at(point);
            double angle = std::atan2(out.cross(back).dot(normal_), out.dot(back));
            angle = angle <= 1e-9 ? angle + 2 * std::numbers::pi : angle;  // clockwise from back
            if (best == edges_.end() || angle < least) {
                best = candidate;
                least = angle;
            }
        }
        require(best != edges_.end());
        return static_cast<std::size_t>(best - edges_.begin());
    }

    // Whether what lies outside of all loops is polygon: the one that reaches farthest is a hole;
    // of several that touch there, the largest.
    [[nodiscard]] bool is_within_holes() const {
        const Point right = normal_.unitOrthogonal();
        std::pair<double, double> farthest = {-std::numeric_limits<double>::infinity(), 0};
        bool is_hole = false;
        for (const auto* loops : {&outers_, &holes_}) {
            for (const Loop& loop : *loops) {
                const double area = std::abs(area_of(points_, loop, normal_));
                for (const std::uint32_t point : loop) {
                    const std::pair reach(points_.at(point).dot(right), area);
                    if (reach > farthest) {
                        farthest = reach;
                        is_hole = loops == &holes_;
                    }
                }
            }
        }
        return is_hole;
    }

    // The smallest polygon around it.
    void put_into_polygon(Loop hole) {
        const Point& a = points_.at(hole[0]);
        const Point& b = points_.at(hole[1]);
        // A little to the left of the hole's first side the polygon is.
        const Point probe = (a + b) / 2 + 1e-4 * normal_.cross(b - a);
        std::vector<Loop>* best = nullptr;
        double least = 0;
        for (std::vector<Loop>& polygon : made_.polygons) {
            if (surrounds(points_, polygon.front(), probe, normal_)) {
                const double area = area_of(points_, polygon.front(), normal_);
                if (best == nullptr || area < least) {
                    best = &polygon;
                    least = area;
                }
            }
        }
        require(best != nullptr);
        best->push_back(std::move(hole));
    }

    PointTable& points_;
    std::vector<PlaneEdge> edges_;
    Point normal_;
    const Rim& given_rim_;
    BoxSides own_;
    std::vector<std::uint32_t> rim_;  // its corners
    std::vector<End> ends_;
    std::vector<std::size_t> number_of_end_;  // by edge
    std::vector<std::uint8_t> is_used_;
    std::vector<Loop> outers_;
    std::vector<Loop> holes_;
    PlaneLoops made_;
};

}  // namespace

PointTable::PointTable(const Bounds& box)
    : box_(box), tolerance_(kSamePlace * (box.max - box.min).maxCoeff()) {}

std::uint32_t PointTable::add(const Point& point) {
    points_.push_back(point);
    sides_.push_back(0);
    return static_cast<std::uint32_t>(points_.size() - 1);
}

std::uint32_t PointTable::on_box(const Point& place) {
    const auto key = static_cast<std::int64_t>(std::floor(place.x() / tolerance_));
    for (auto at = on_box_.lower_bound(key - 1); at != on_box_.end() && at->first <= key + 1;
         ++at) {
        if ((points_[at->second] - place).cwiseAbs().maxCoeff() <= tolerance_) {
            return at->second;
        }
    }
    const std::uint32_t point = add(place);
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_max : {false, true}) {
            const double side = is_max ? box_.max[axis] : box_.min[axis];
            if (std::abs(place[axis] - side) <= tolerance_) {
                sides_[point] |= static_cast<BoxSides>(1U << (2 * axis + int{is_max}));
            }
        }
    }
    on_box_.emplace(key, point);
    return point;
}

std::optional<PlaneLoops> find_loops(
    PointTable& points,
    std::span<const PlaneEdge> edges,
    const Point& normal,
    const Rim& rim,
    BoxSides own,
    bool is_full
) {
    try {
        return LoopFinder(points, edges, normal, rim, own).find(is_full);
    } catch (const Inconsistent&) {
        return std::nullopt;
    }
}

}  // namespace modelsynth::continuous
