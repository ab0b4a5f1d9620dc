#include "tests/support/surface_checker.h"

#include "tests/support/figure_sampler.h"
#include "tests/support/solid_places.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace modelsynth::testing {

namespace {

using continuous::Example;
using continuous::Face;
using continuous::Polyhedron;
using continuous::Surface;

SpacePolygon polygon_of(std::size_t solid, const Polyhedron& polyhedron, const Face& face) {
    SpaceLoop loop;
    for (const std::uint32_t corner : face) {
        loop.push_back(polyhedron.corners[corner]);
    }
    return make_space_polygon(solid, {std::move(loop)});
}

void add_box(std::size_t solid, const Eigen::AlignedBox3d& box, std::vector<SpacePolygon>& to) {
    for (int axis = 0; axis < 3; ++axis) {
        const int right = (axis + 1) % 3;
        const int up = (axis + 2) % 3;
        for (const bool is_max : {false, true}) {
            SpaceLoop loop(4);
            for (std::size_t i = 0; i < 4; ++i) {
                loop[i][axis] = is_max ? box.max()[axis] : box.min()[axis];
                loop[i][right] = i == 1 || i == 2 ? box.max()[right] : box.min()[right];
                loop[i][up] = i >= 2 ? box.max()[up] : box.min()[up];
            }
            if (!is_max) {
                std::reverse(loop.begin(), loop.end());
            }
            to.push_back(make_space_polygon(solid, {std::move(loop)}));
        }
    }
}

Eigen::AlignedBox3d inflated(Eigen::AlignedBox3d box, double by) {
    box.min().array() -= by;
    box.max().array() += by;
    return box;
}

// Solid 0 is the ground, as far as the example has one.
PolygonSet solids_of(const Example& example) {
    std::vector<SpacePolygon> polygons;
    std::vector<ObjectId> objects = {example.ground.value_or(continuous::kEmpty)};
    Eigen::AlignedBox3d box;
    for (const Polyhedron& polyhedron : example.polyhedra) {
        for (const Face& face : polyhedron.faces) {
            polygons.push_back(polygon_of(objects.size(), polyhedron, face));
            box.extend(polygons.back().box);
        }
        objects.push_back(polyhedron.object);
    }
    box = box.isEmpty() ? Eigen::AlignedBox3d(Point::Zero()) : box;
    const double extent = std::max(box.sizes().maxCoeff(), 1e-3);
    PolygonSet::Frame frame;
    frame.tolerance = 8e-6 * extent;
    frame.reach = extent;
    frame.clip = inflated(box, extent);
    if (example.ground) {  // however high the solids float
        frame.clip.extend(Point(box.min().x(), -extent, box.min().z()));
        frame.clip.extend(Point(box.min().x(), extent, box.min().z()));
    }
    if (example.bounds) {
        frame.clip = Eigen::AlignedBox3d(example.bounds->min, example.bounds->max);
    }
    if (example.ground) {
        Eigen::AlignedBox3d ground = inflated(box.extend(frame.clip), extent);
        ground.max().y() = 0;
        add_box(0, ground, polygons);
    }
    return {std::move(polygons), std::move(objects), frame};
}

std::vector<Point> normals_of(const Example& example) {
    std::vector<Point> normals;
    for (const Polyhedron& polyhedron : example.polyhedra) {
        for (const Face& face : polyhedron.faces) {
            const SpacePolygon polygon = polygon_of(0, polyhedron, face);
            const bool is_seen =
                !example.bounds || ((polygon.box.max() - example.bounds->min).minCoeff() > 0 &&
                                    (example.bounds->max - polygon.box.min()).minCoeff() > 0);
            if (is_seen) {
                normals.push_back(polygon.normal);
            }
        }
    }
    if (example.ground) {
        normals.push_back(Point::UnitY());
    }
    return normals;
}

std::string text(const Point& point) {
    char buffer[100];
    std::snprintf(buffer, sizeof buffer, "(%.6g, %.6g, %.6g)", point.x(), point.y(), point.z());
    return buffer;
}

// Two that show the same of every solid.
void check_windings(const PolygonSet& set, const Point& point, FaultList& faults) {
    const std::vector<double> exact = set.exact_windings(point);
    const std::vector<int> counted = set.windings(point);
    for (std::size_t solid = 0; solid < exact.size(); ++solid) {
        if (std::abs(exact[solid] - counted[solid]) > 1e-6) {
            faults.add(
                "object " + std::to_string(solid) + " goes " + std::to_string(exact[solid]) +
                " times round " + text(point) + " but a ray crosses it " +
                std::to_string(counted[solid]) + " times"
            );
        }
        if (counted[solid] != 0 && counted[solid] != 1) {
            faults.add(
                "object " + std::to_string(solid) + " goes " + std::to_string(counted[solid]) +
                " times round " + text(point)
            );
        }
    }
    if (std::count(counted.begin(), counted.end(), 1) > 1) {
        faults.add("two objects are at " + text(point));
    }
}

// Some of the points, in random order, or all.
std::vector<Point> choose(std::vector<Point> points, std::size_t count) {
    std::mt19937_64 random(1);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        std::swap(points[i], points[i + random() % (points.size() - i)]);
    }
    points.resize(std::min(points.size(), count));
    return points;
}

// What is cut off near one of its own corners may be finer than can be told apart.
bool is_near_cut(const Point& point, const Eigen::AlignedBox3d& box, const CutSides& cuts) {
    constexpr double kNear = 0.02;  // metres
    for (int axis = 0; axis < 3; ++axis) {
        const auto side = static_cast<std::size_t>(2 * axis);
        if ((cuts[side] && point[axis] - box.min()[axis] < kNear) ||
            (cuts[side + 1] && box.max()[axis] - point[axis] < kNear)) {
            return true;
        }
    }
    return false;
}

}  // namespace

SurfaceChecker::SurfaceChecker(Example example)
    : example_(std::move(example)), cells_(normals_of(example_)) {
    const PolygonSet solids = solids_of(example_);
    for (const Point& point : find_special_points(solids, true)) {
        figures_.insert(sample_figure(solids, cells_, point).objects);
    }
    if (example_.ground && !example_.bounds) {  // which is bare beside all solids
        Point beside = solids.frame().clip.max().array() - solids.frame().reach / 2;
        beside.y() = 0;
        figures_.insert(sample_figure(solids, cells_, beside).objects);
    }
}

ModelFaults SurfaceChecker::find_faults(
    const Surface& surface,
    const Eigen::AlignedBox3d& box,
    std::size_t points_max,
    const CutSides& cuts
) const {
    FaultList faults;
    find_invalid_numbers(example_, surface, faults);
    if (!faults.is_empty()) {
        return faults.take();
    }
    const PolygonSet solids = solids_of(surface, example_.objects.size(), box);
    find_false_polygons(example_, cells_, solids, cuts, faults);
    find_open_borders(surface, solids.polygons(), faults);
    find_corners_on_sides(surface, faults);
    if (!faults.is_empty()) {
        return faults.take();  // what follows relies on it
    }

    std::mt19937_64 random(1);
    const auto share = [&] { return static_cast<double>(random() % 1'000'003) / 1'000'003; };
    for (int i = 0; i < 100; ++i) {
        const Point place(share(), share(), share());
        check_windings(solids, box.min() + place.cwiseProduct(box.sizes()), faults);
    }
    for (const Point& point : choose(find_special_points(solids, false), points_max)) {
        if (is_near_cut(point, box, cuts)) {
            continue;
        }
        const SampledFigure figure = sample_figure(solids, cells_, point);
        const std::string place = " at " + text(point);
        if (figure.is_foreign) {
            faults.add("a polygon that looks where nothing of the example does" + place);
        } else if (figure.is_unclear) {
            faults.add("polygons that come too near to each other" + place);
        } else if (figure.is_inside_out) {
            faults.add("a border that encloses space other than once" + place);
        } else if (figure.is_overlap) {
            faults.add("objects that overlap" + place);
        } else if (!figures_.contains(figure.objects)) {
            faults.add("what stands nowhere in the example" + place);
        }
    }
    return faults.take();
}

ModelFaults SurfaceChecker::find_faults(const Scene& scene, const Surface& surface) const {
    FaultList faults;
    const PolygonSet solids = solids_of(surface, example_.objects.size(), {});
    check_scene(example_, scene, solids.polygons(), faults);
    return faults.take();
}

}  // namespace modelsynth::testing
