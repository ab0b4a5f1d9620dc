#include "tests/support/solid_places.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace modelsynth::testing {

namespace {

// What is nearer touches, metres.
constexpr double kNear = 1e-6;

PolygonSet set_of(
    const continuous::Surface& surface, std::size_t object_types, const Eigen::AlignedBox3d& box
) {
    std::vector<SpacePolygon> polygons;
    std::vector<ObjectId> objects;
    for (std::size_t object = 0; object <= object_types; ++object) {
        objects.push_back(static_cast<ObjectId>(object));
    }
    for (const continuous::SurfacePolygon& polygon : surface.polygons) {
        std::vector<SpaceLoop> loops;
        for (const std::vector<std::uint32_t>& loop : polygon.loops) {
            SpaceLoop& corners = loops.emplace_back();
            for (const std::uint32_t corner : loop) {
                corners.push_back(surface.points[corner]);
            }
        }
        polygons.push_back(make_space_polygon(polygon.object, std::move(loops)));
    }
    PolygonSet::Frame frame;
    frame.clip = box;
    return {std::move(polygons), std::move(objects), frame};
}

double distance_of_segments(const Point& a, const Point& b, const Point& c, const Point& d) {
    const Point u = b - a;
    const Point v = d - c;
    const Point w = a - c;
    const double uu = u.dot(u);
    const double uv = u.dot(v);
    const double vv = v.dot(v);
    const double determinant = uu * vv - uv * uv;
    if (determinant <= 1e-12 * uu * vv) {
        return 1e9;  // parallel ones come nearest at their ends, which are looked at as corners
    }
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / determinant;
    const double t = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
    const Point from = a + std::clamp(s, 0.0, 1.0) * u;
    const Point to = c + std::clamp(t, 0.0, 1.0) * v;
    return (from - to).norm();
}

bool has_corner_on(const SpacePolygon& one, const SpacePolygon& other) {
    for (const SpaceLoop& loop : one.loops) {
        for (const Point& corner : loop) {
            if (distance(other, corner) < kNear) {
                return true;
            }
        }
    }
    return false;
}

bool have_sides_that_cross(const SpacePolygon& one, const SpacePolygon& other) {
    for (const SpaceLoop& loop : one.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            for (const SpaceLoop& beside : other.loops) {
                for (std::size_t j = 0; j < beside.size(); ++j) {
                    const double gap = distance_of_segments(
                        loop[i],
                        loop[(i + 1) % loop.size()],
                        beside[j],
                        beside[(j + 1) % beside.size()]
                    );
                    if (gap < kNear) {
                        return true;
                    }
                }
            }
        }
    }
    return false;
}

// Solids do not go through each other, so that what touches has a corner on the other's border or
// sides that cross.
bool touch(const SpacePolygon& one, const SpacePolygon& other) {
    const Eigen::AlignedBox3d& a = one.box;
    const Eigen::AlignedBox3d& b = other.box;
    if ((a.min() - b.max()).maxCoeff() > kNear || (b.min() - a.max()).maxCoeff() > kNear) {
        return false;
    }
    return has_corner_on(one, other) || has_corner_on(other, one) ||
           have_sides_that_cross(one, other);
}

}  // namespace

SolidPlaces::SolidPlaces(
    const continuous::Surface& surface, std::size_t object_types, const Eigen::AlignedBox3d& box
)
    : set_(set_of(surface, object_types, box)) {}

ObjectId SolidPlaces::at(const Point& point) const {
    const std::vector<int> windings = set_.windings(point);
    const auto found = std::find(windings.begin(), windings.end(), 1);
    return found == windings.end() ? continuous::kEmpty
                                   : static_cast<ObjectId>(found - windings.begin());
}

std::size_t SolidPlaces::pieces(const std::vector<ObjectId>& objects) const {
    std::vector<const SpacePolygon*> polygons;
    for (const SpacePolygon& polygon : set_.polygons()) {
        if (std::find(objects.begin(), objects.end(), polygon.solid) != objects.end()) {
            polygons.push_back(&polygon);
        }
    }
    std::sort(polygons.begin(), polygons.end(), [](const auto* a, const auto* b) {
        return a->box.min().x() < b->box.min().x();
    });
    std::vector<std::size_t> parent(polygons.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        for (std::size_t j = i + 1; j < polygons.size(); ++j) {
            if (polygons[j]->box.min().x() > polygons[i]->box.max().x() + kNear) {
                break;
            }
            if (root(i) != root(j) && touch(*polygons[i], *polygons[j])) {
                parent[root(i)] = root(j);
            }
        }
    }
    std::vector<double> enclosed(polygons.size());
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        enclosed[root(i)] += polygons[i]->offset * polygons[i]->area / 3;
    }
    return static_cast<std::size_t>(
        std::count_if(enclosed.begin(), enclosed.end(), [](double volume) { return volume > 1e-9; })
    );
}

}  // namespace modelsynth::testing
