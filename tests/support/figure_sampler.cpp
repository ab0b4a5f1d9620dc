#include "tests/support/figure_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace modelsynth::testing {

namespace {

struct Segment {
    Point a;
    Point b;
};

Eigen::AlignedBox3d box_of(const Segment& segment, double margin) {
    Eigen::AlignedBox3d box(segment.a);
    box.extend(segment.b);
    box.min().array() -= margin;
    box.max().array() += margin;
    return box;
}

// Every side of a polygon, whichever polygons it is of, once.
std::vector<Segment> sides_of(const std::vector<SpacePolygon>& polygons) {
    std::set<std::array<double, 6>> known;
    std::vector<Segment> segments;
    for (const SpacePolygon& polygon : polygons) {
        for (const SpaceLoop& loop : polygon.loops) {
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Point& a = loop[i];
                const Point& b = loop[(i + 1) % loop.size()];
                const std::array<double, 3> from = {a.x(), a.y(), a.z()};
                const std::array<double, 3> to = {b.x(), b.y(), b.z()};
                const auto& [low, high] = std::minmax(from, to);
                if (known.insert({low[0], low[1], low[2], high[0], high[1], high[2]}).second) {
                    segments.push_back({a, b});
                }
            }
        }
    }
    return segments;
}

// The faces of the clip, as polygons.
std::vector<SpacePolygon> faces_of(const Eigen::AlignedBox3d& box) {
    std::vector<SpacePolygon> faces;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double at : {box.min()[axis], box.max()[axis]}) {
            SpaceLoop loop(4);
            for (std::size_t i = 0; i < 4; ++i) {
                loop[i][axis] = at;
                const int right = (axis + 1) % 3;
                const int up = (axis + 2) % 3;
                loop[i][right] = i == 1 || i == 2 ? box.max()[right] : box.min()[right];
                loop[i][up] = i >= 2 ? box.max()[up] : box.min()[up];
            }
            faces.push_back(make_space_polygon(0, {loop}));
        }
    }
    return faces;
}

class PointFinder {
  public:
    explicit PointFinder(const PolygonSet& set)
        : set_(set), tolerance_(set.frame().tolerance), segments_(sides_of(set.polygons())) {}

    // Adds the lines along which polygons go through each other or the clip's sides.
    void add_crossings() {
        const std::vector<SpacePolygon>& polygons = set_.polygons();
        for (const SpacePolygon& face : faces_of(set_.frame().clip)) {
            for (const SpacePolygon& polygon : polygons) {
                add_crossing(polygon, face);
            }
        }
        for (std::size_t i = 0; i < polygons.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                if (polygons[i].solid != polygons[j].solid) {
                    add_crossing(polygons[i], polygons[j]);
                }
            }
        }
    }

    std::vector<Point> find() {
        for (const Segment& segment : segments_) {
            look_along(segment);
        }
        return std::move(points_);
    }

  private:
    void add_crossing(const SpacePolygon& one, const SpacePolygon& other) {
        const Point along = one.normal.cross(other.normal);
        Eigen::AlignedBox3d reach = other.box;
        reach.min().array() -= tolerance_;
        reach.max().array() += tolerance_;
        if (along.norm() < 1e-5 || !one.box.intersects(reach)) {
            return;
        }
        // A point on both planes, near the polygons.
        Eigen::Matrix3d rows;
        rows << one.normal.transpose(), other.normal.transpose(), along.transpose();
        const Point near = one.box.center();
        const Point origin = rows.inverse() * Point(one.offset, other.offset, along.dot(near));
        const Point direction = along.normalized();
        std::vector<double> stops;
        for (const SpacePolygon* polygon : {&one, &other}) {
            const Point& cut = polygon == &one ? other.normal : one.normal;
            const double offset = polygon == &one ? other.offset : one.offset;
            for (const SpaceLoop& loop : polygon->loops) {
                for (std::size_t i = 0; i < loop.size(); ++i) {
                    const double from = cut.dot(loop[i]) - offset;
                    const double to = cut.dot(loop[(i + 1) % loop.size()]) - offset;
                    if (std::abs(from) <= tolerance_) {
                        stops.push_back(direction.dot(loop[i] - origin));
                    } else if (from * to < 0) {
                        const Point at =
                            loop[i] + from / (from - to) * (loop[(i + 1) % loop.size()] - loop[i]);
                        stops.push_back(direction.dot(at - origin));
                    }
                }
            }
        }
        std::sort(stops.begin(), stops.end());
        for (std::size_t i = 1; i < stops.size(); ++i) {
            const Point middle = origin + (stops[i - 1] + stops[i]) / 2 * direction;
            if (stops[i] - stops[i - 1] > tolerance_ && distance(one, middle) <= tolerance_ &&
                distance(other, middle) <= tolerance_) {
                segments_.push_back(
                    {origin + stops[i - 1] * direction, origin + stops[i] * direction}
                );
            }
        }
    }

    void look_along(const Segment& segment) {
        const double length = (segment.b - segment.a).norm();
        std::vector<double> stops = {0, length};
        for (const SpacePolygon& polygon : set_.polygons()) {
            if (polygon.box.intersects(box_of(segment, tolerance_))) {
                add_contacts(segment, polygon, stops);
            }
        }
        const Point along = (segment.b - segment.a) / length;
        for (int axis = 0; axis < 3; ++axis) {
            for (const double end :
                 {set_.frame().clip.min()[axis], set_.frame().clip.max()[axis]}) {
                const double at = (end - segment.a[axis]) / along[axis];
                if (at > 0 && at < length) {  // not where the segment is parallel to that end
                    stops.push_back(at);
                }
            }
        }
        std::sort(stops.begin(), stops.end());
        double last = 0;
        add(segment.a);
        for (const double stop : stops) {
            if (stop - last <= tolerance_) {
                continue;
            }
            add(segment.a + stop * along);
            const Point middle = segment.a + (stop + last) / 2 * along;
            add(middle);
            add_beside(middle, along);
            last = stop;
        }
    }

    // Where a segment comes onto a polygon or over its border.
    void add_contacts(
        const Segment& segment, const SpacePolygon& polygon, std::vector<double>& stops
    ) const {
        const double length = (segment.b - segment.a).norm();
        const Point along = (segment.b - segment.a) / length;
        const double from = polygon.normal.dot(segment.a) - polygon.offset;
        const double slope = polygon.normal.dot(along);
        if (std::abs(slope) * length > 2 * tolerance_) {
            const double at = std::clamp(-from / slope, 0.0, length);
            if (distance(polygon, segment.a + at * along) <= tolerance_) {
                stops.push_back(at);
            }
        } else if (std::abs(from) <= 4 * tolerance_) {
            for (const SpaceLoop& loop : polygon.loops) {
                for (std::size_t i = 0; i < loop.size(); ++i) {
                    const Point& c = loop[i];
                    const Point side = loop[(i + 1) % loop.size()] - c;
                    const Point across = side.cross(polygon.normal);  // in the plane
                    const double turn = along.dot(across);
                    const double at = std::abs(turn) > 1e-6 * side.norm()
                                          ? (c - segment.a).dot(across) / turn
                                          : (c - segment.a).dot(along);
                    const Point place = segment.a + at * along;
                    const double t = (place - c).dot(side) / side.squaredNorm();
                    const Point foot = c + std::clamp(t, 0.0, 1.0) * side;
                    if (at > 0 && at < length && (foot - place).norm() <= tolerance_) {
                        stops.push_back(at);
                    }
                }
            }
        }
    }

    // Points of all polygons through a point of an edge, on both sides of the edge.
    void add_beside(const Point& middle, const Point& along) {
        const Surroundings around = set_.surroundings(middle);
        for (const std::uint32_t number : around.through) {
            const SpacePolygon& polygon = set_.polygons()[number];
            const Point sideways = around.gap / 4 * polygon.normal.cross(along).normalized();
            for (const Point& point : {Point(middle + sideways), Point(middle - sideways)}) {
                if (distance(polygon, point) <= tolerance_) {
                    add(point);
                }
            }
        }
    }

    void add(const Point& point) {
        std::array<long, 3> place = {};
        for (int axis = 0; axis < 3; ++axis) {
            place[static_cast<std::size_t>(axis)] = std::lround(point[axis] / (tolerance_ / 4));
        }
        if (set_.is_inside_clip(point) && places_.insert(place).second) {
            points_.push_back(point);
        }
    }

    const PolygonSet& set_;
    double tolerance_;
    std::vector<Segment> segments_;
    std::set<std::array<long, 3>> places_;
    std::vector<Point> points_;
};

}  // namespace

std::vector<Point> find_special_points(const PolygonSet& set, bool may_overlap) {
    PointFinder finder(set);
    if (may_overlap) {
        finder.add_crossings();
    }
    return finder.find();
}

SampledFigure sample_figure(const PolygonSet& set, const ConeCells& cells, const Point& point) {
    SampledFigure figure;
    const Surroundings around = set.surroundings(point);
    std::uint64_t here = 0;
    for (const std::uint32_t number : around.through) {
        const auto family = cells.find(set.polygons()[number].normal);
        figure.is_foreign = figure.is_foreign || !family;
        here |= family ? std::uint64_t{1} << *family : 0;
    }
    const Eigen::AlignedBox3d& clip = set.frame().clip;
    const double to_clip =
        std::min((point - clip.min()).minCoeff(), (clip.max() - point).minCoeff());
    const double gap = std::min(around.gap, to_clip);
    figure.is_unclear = gap < 4 * set.frame().tolerance;

    // Cells that only planes elsewhere cut apart are one, and the direction into it is that which
    // is farthest from the planes that are here.
    struct Cone {
        double clearance = -1;
        Point direction;
        ObjectId object = 0;
    };

    std::map<std::uint64_t, Cone> cones;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        double clearance = 1;
        for (std::size_t family = 0; family < cells.normals().size(); ++family) {
            if ((here >> family & 1) != 0) {
                const double slope = cells.normals()[family].dot(cells.inside(cell));
                clearance = std::min(clearance, std::abs(slope));
            }
        }
        Cone& cone = cones[cells.sides(cell) & here];
        if (clearance > cone.clearance) {
            cone.clearance = clearance;
            cone.direction = cells.inside(cell);
        }
    }
    for (auto& [sides, cone] : cones) {
        const std::vector<int> windings = set.windings(point + gap / 4 * cone.direction);
        int filled = 0;
        for (std::size_t solid = 0; solid < windings.size(); ++solid) {
            if (windings[solid] == 1) {
                cone.object = set.objects()[solid];
                ++filled;
            }
            figure.is_inside_out |= windings[solid] != 0 && windings[solid] != 1;
        }
        figure.is_overlap |= filled > 1;
    }
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        figure.objects.push_back(static_cast<char>(cones.at(cells.sides(cell) & here).object));
    }
    return figure;
}

}  // namespace modelsynth::testing
