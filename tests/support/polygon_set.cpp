#include "tests/support/polygon_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace modelsynth::testing {

namespace {

// Van Oosterom and Strackee (1983), of a triangle seen from the origin.
double solid_angle(const Point& a, const Point& b, const Point& c) {
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    const double rest = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    return 2 * std::atan2(a.dot(b.cross(c)), rest);
}

double distance_to_segment(const Point& point, const Point& a, const Point& b) {
    const Point along = b - a;
    const double t = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (a + t * along - point).norm();
}

// Calls visit(corner, next corner) for every side.
template <class Visit>
void for_each_side(const SpacePolygon& polygon, Visit visit) {
    for (const SpaceLoop& loop : polygon.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            visit(loop[i], loop[i + 1 < loop.size() ? i + 1 : 0]);
        }
    }
}

int steepest_axis(const Point& normal) {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    return axis;
}

}  // namespace

SpacePolygon make_space_polygon(std::size_t solid, std::vector<SpaceLoop> loops) {
    SpacePolygon polygon;
    polygon.solid = solid;
    polygon.loops = std::move(loops);
    const Point origin = polygon.loops.front().front();
    Point twice_area = Point::Zero();
    for_each_side(polygon, [&](const Point& a, const Point& b) {
        twice_area += (a - origin).cross(b - origin);
        polygon.box.extend(a);
    });
    polygon.area = twice_area.norm() / 2;
    polygon.normal = twice_area.normalized();
    double corners = 0;
    for_each_side(polygon, [&](const Point& a, const Point& /*b*/) {
        polygon.offset += polygon.normal.dot(a);
        ++corners;
    });
    polygon.offset /= corners;
    return polygon;
}

std::optional<int> turns_round(
    const SpacePolygon& polygon, const Point& point, int axis, double near
) {
    const int right = (axis + 1) % 3;
    const int up = (axis + 2) % 3;
    int turns = 0;
    bool is_near = false;
    for_each_side(polygon, [&](const Point& a, const Point& b) {
        const double au = a[right] - point[right];
        const double av = a[up] - point[up];
        const double bu = b[right] - point[right];
        const double bv = b[up] - point[up];
        if (std::min(av, bv) > near || std::max(av, bv) < -near) {
            if ((av <= 0) == (bv <= 0)) {
                return;
            }
        }
        const double side = au * bv - bu * av;
        if (std::abs(side) <= near * std::hypot(bu - au, bv - av) && std::min(au, bu) <= near &&
            std::max(au, bu) >= -near) {
            is_near = true;
        }
        if (av <= 0 && bv > 0) {
            turns += side > 0 ? 1 : 0;
        } else if (av > 0 && bv <= 0) {
            turns -= side < 0 ? 1 : 0;
        }
    });
    return is_near ? std::nullopt : std::optional(turns);
}

bool covers(const SpacePolygon& polygon, const Point& point) {
    const int axis = steepest_axis(polygon.normal);
    // Along a slanted normal the point and its foot look different.
    const Point foot = point - (polygon.normal.dot(point) - polygon.offset) * polygon.normal;
    return *turns_round(polygon, foot, axis) != 0;
}

double distance(const SpacePolygon& polygon, const Point& point) {
    if (covers(polygon, point)) {
        return std::abs(polygon.normal.dot(point) - polygon.offset);
    }
    double nearest = std::numeric_limits<double>::infinity();
    for_each_side(polygon, [&](const Point& a, const Point& b) {
        nearest = std::min(nearest, distance_to_segment(point, a, b));
    });
    return nearest;
}

double solid_angle(const SpacePolygon& polygon, const Point& point) {
    // Triangles from one corner, also to the holes: what they have too much cancels.
    const Point hub = polygon.loops.front().front() - point;
    double sum = 0;
    for_each_side(polygon, [&](const Point& a, const Point& b) {
        sum += solid_angle(hub, a - point, b - point);
    });
    return sum;
}

PolygonSet::PolygonSet(
    std::vector<SpacePolygon> polygons, std::vector<ObjectId> objects, Frame frame
)
    : polygons_(std::move(polygons)), objects_(std::move(objects)), frame_(frame) {
    extent_.extend(Point::Zero());
    for (const SpacePolygon& polygon : polygons_) {
        extent_.extend(polygon.box);
    }
    extent_.max() += Point::Constant(1e-3);
    const Point step = extent_.sizes() / kColumns;
    const auto index = [&](double at, int axis) {
        return std::clamp(
            static_cast<int>((at - extent_.min()[axis]) / step[axis]), 0, kColumns - 1
        );
    };
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
        const Eigen::AlignedBox3d& box = polygons_[i].box;
        if (std::abs(polygons_[i].normal.y()) < 1e-9) {
            continue;  // a ray upwards does not cross it
        }
        for (int z = index(box.min().z(), 2); z <= index(box.max().z(), 2); ++z) {
            for (int x = index(box.min().x(), 0); x <= index(box.max().x(), 0); ++x) {
                columns_[static_cast<std::size_t>(x + kColumns * z)].push_back(
                    static_cast<std::uint32_t>(i)
                );
            }
        }
    }
}

const std::vector<std::uint32_t>& PolygonSet::column(const Point& point) const {
    const Point place = (point - extent_.min()).cwiseQuotient(extent_.sizes()) * kColumns;
    const int x = std::clamp(static_cast<int>(place.x()), 0, kColumns - 1);
    const int z = std::clamp(static_cast<int>(place.z()), 0, kColumns - 1);
    return columns_[static_cast<std::size_t>(x + kColumns * z)];
}

bool PolygonSet::is_inside_clip(const Point& point) const {
    return ((point - frame_.clip.min()).array() > frame_.tolerance).all() &&
           ((frame_.clip.max() - point).array() > frame_.tolerance).all();
}

Surroundings PolygonSet::surroundings(const Point& point) const {
    Surroundings found;
    found.gap = frame_.reach;
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
        if (polygons_[i].box.exteriorDistance(point) >= found.gap) {
            continue;
        }
        const double away = distance(polygons_[i], point);
        if (away <= frame_.tolerance) {
            found.through.push_back(static_cast<std::uint32_t>(i));
        } else {
            found.gap = std::min(found.gap, away);
        }
    }
    return found;
}

std::vector<int> PolygonSet::windings(const Point& point) const {
    std::vector<int> result(objects_.size());
    for (const std::uint32_t i : column(point)) {
        const SpacePolygon& polygon = polygons_[i];
        if (polygon.box.max().y() < point.y()) {
            continue;
        }
        const auto turns = turns_round(polygon, point, 1, 1e-10);
        if (!turns) {
            const std::vector<double> exact = exact_windings(point);
            for (std::size_t solid = 0; solid < exact.size(); ++solid) {
                result[solid] = static_cast<int>(std::lround(exact[solid]));
            }
            return result;
        }
        const double height = (polygon.offset - polygon.normal.dot(point)) / polygon.normal.y();
        result[polygon.solid] += height > 0 ? *turns : 0;
    }
    return result;
}

std::vector<double> PolygonSet::exact_windings(const Point& point) const {
    std::vector<double> result(objects_.size());
    for (const SpacePolygon& polygon : polygons_) {
        result[polygon.solid] += solid_angle(polygon, point) / (4 * std::numbers::pi);
    }
    return result;
}

}  // namespace modelsynth::testing
