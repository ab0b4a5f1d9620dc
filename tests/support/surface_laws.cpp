#include "tests/support/surface_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>

namespace modelsynth::testing {

namespace {

using continuous::Surface;
using continuous::SurfacePolygon;

constexpr double kFlat = 1e-7;    // metres
constexpr double kBeside = 1e-6;  // metres; far less than anything is large
constexpr double kSameNormal = 1e-5;

std::string name(std::size_t polygon) { return "polygon " + std::to_string(polygon); }

// Calls visit(from, to) for the numbers of the points of every side.
template <class Visit>
void for_each_side(const SurfacePolygon& polygon, Visit visit) {
    for (const std::vector<std::uint32_t>& loop : polygon.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            visit(loop[i], loop[(i + 1) % loop.size()]);
        }
    }
}

template <class Visit>
void for_each_side(const SpacePolygon& polygon, Visit visit) {
    for (const SpaceLoop& loop : polygon.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            visit(loop[i], loop[(i + 1) % loop.size()]);
        }
    }
}

bool is_flat(const SpacePolygon& polygon) {
    bool result = polygon.area > 0;
    for_each_side(polygon, [&](const Point& a, const Point& /*b*/) {
        result = result && std::abs(polygon.normal.dot(a) - polygon.offset) <= kFlat;
    });
    return result;
}

double area_of(const SpaceLoop& loop, const Point& normal) {
    Point sum = Point::Zero();
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        sum += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]) / 2;
    }
    return sum.dot(normal);
}

// A polygon lies once to the left of its sides and not to the right.
bool is_simple(const SpacePolygon& polygon) {
    int axis = 0;
    polygon.normal.cwiseAbs().maxCoeff(&axis);
    const int inside = polygon.normal[axis] > 0 ? 1 : -1;
    bool result = area_of(polygon.loops.front(), polygon.normal) > 0;
    for (std::size_t i = 1; i < polygon.loops.size(); ++i) {
        result = result && area_of(polygon.loops[i], polygon.normal) < 0;
    }
    for_each_side(polygon, [&](const Point& a, const Point& b) {
        const Point left = kBeside * polygon.normal.cross(b - a).normalized();
        // Not the middle, which more often has something in common with other sides.
        const Point middle = a + 0.47 * (b - a);
        result = result && *turns_round(polygon, middle + left, axis) == inside &&
                 *turns_round(polygon, middle - left, axis) == 0;
    });
    return result;
}

// Whether the model's box ends an object there: the ground anywhere, others at sides that cut.
bool is_end_of_model(
    const SpacePolygon& polygon,
    const continuous::Example& example,
    const Eigen::AlignedBox3d& box,
    const CutSides& cuts
) {
    const bool is_ground = example.ground && polygon.solid == *example.ground;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_max : {false, true}) {
            if (!is_ground && !cuts[static_cast<std::size_t>(2 * axis + int{is_max})]) {
                continue;
            }
            const double end = is_max ? box.max()[axis] : box.min()[axis];
            const bool is_there = std::abs(polygon.box.min()[axis] - end) < kFlat &&
                                  std::abs(polygon.box.max()[axis] - end) < kFlat;
            if (is_there && std::abs(polygon.normal[axis] - (is_max ? 1 : -1)) < kSameNormal) {
                return true;
            }
        }
    }
    return false;
}

using Edge = std::tuple<std::size_t, std::uint32_t, std::uint32_t>;  // object, from, to

// Two halves of a flat part that should be one.
void find_split(
    const std::vector<SpacePolygon>& polygons,
    const std::vector<std::size_t>& forth,
    const std::vector<std::size_t>& back,
    FaultList& faults
) {
    for (const std::size_t a : forth) {
        for (const std::size_t b : back) {
            if ((polygons[a].normal - polygons[b].normal).norm() < kSameNormal) {
                faults.add(name(a) + " and " + name(b) + " should be one");
            }
        }
    }
}

}  // namespace

void find_invalid_numbers(
    const continuous::Example& example, const Surface& surface, FaultList& faults
) {
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        const SurfacePolygon& polygon = surface.polygons[p];
        if (polygon.object == 0 || polygon.object > example.objects.size()) {
            faults.add(name(p) + " is of no object of the example");
        }
        if (polygon.loops.empty()) {
            faults.add(name(p) + " has no loops");
        }
        for (const std::vector<std::uint32_t>& loop : polygon.loops) {
            const bool are_points = std::all_of(loop.begin(), loop.end(), [&](std::uint32_t i) {
                return i < surface.points.size() && surface.points[i].allFinite();
            });
            if (loop.size() < 3 || !are_points) {
                faults.add(name(p) + " has a loop that is none");
            }
        }
    }
}

void find_false_polygons(
    const continuous::Example& example,
    const ConeCells& cells,
    const PolygonSet& solids,
    const CutSides& cuts,
    FaultList& faults
) {
    Eigen::AlignedBox3d reach = solids.frame().clip;
    reach.min().array() -= kFlat;
    reach.max().array() += kFlat;
    for (std::size_t p = 0; p < solids.polygons().size(); ++p) {
        const SpacePolygon& polygon = solids.polygons()[p];
        if (!is_flat(polygon)) {
            faults.add(name(p) + " is not flat");
        } else if (!is_simple(polygon)) {
            faults.add(name(p) + " has loops that cross, or holes outside of it");
        } else if (!reach.contains(polygon.box)) {
            faults.add(name(p) + " leaves the box");
        } else if (!cells.find(polygon.normal) && !is_end_of_model(polygon, example, solids.frame().clip, cuts)) {
            faults.add(name(p) + " looks where no face of the example does");
        }
    }
}

void find_open_borders(
    const Surface& surface, const std::vector<SpacePolygon>& polygons, FaultList& faults
) {
    std::map<Edge, std::vector<std::size_t>> polygons_at;
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        const SurfacePolygon& polygon = surface.polygons[p];
        for_each_side(polygon, [&](std::uint32_t from, std::uint32_t to) {
            std::vector<std::size_t>& there = polygons_at[{polygon.object, from, to}];
            if (std::find(there.begin(), there.end(), p) != there.end()) {
                faults.add(name(p) + " has a side twice");
            }
            there.push_back(p);
        });
    }
    for (const auto& [edge, forth] : polygons_at) {
        const auto& [object, from, to] = edge;
        const auto back = polygons_at.find({object, to, from});
        if (back == polygons_at.end() || back->second.size() != forth.size()) {
            faults.add(
                "object " + std::to_string(object) + " is open from point " + std::to_string(from) +
                " to " + std::to_string(to)
            );
        } else if (from < to) {
            find_split(polygons, forth, back->second, faults);
        }
    }
    std::map<std::size_t, double> volumes;
    for (const SpacePolygon& polygon : polygons) {
        volumes[polygon.solid] += polygon.offset * polygon.area / 3;
    }
    for (const auto& [object, volume] : volumes) {
        if (volume <= 0) {
            faults.add("object " + std::to_string(object) + " is inside out");
        }
    }
}

void find_corners_on_sides(const Surface& surface, FaultList& faults) {
    std::set<std::pair<ObjectId, std::uint32_t>> corners;
    std::set<Edge> sides;
    for (const SurfacePolygon& polygon : surface.polygons) {
        for_each_side(polygon, [&](std::uint32_t from, std::uint32_t to) {
            corners.emplace(polygon.object, from);
            sides.emplace(polygon.object, std::min(from, to), std::max(from, to));
        });
    }
    std::map<ObjectId, std::vector<std::pair<double, std::uint32_t>>> by_x;
    for (const auto& [object, corner] : corners) {
        by_x[object].emplace_back(surface.points[corner].x(), corner);
    }
    for (auto& [object, list] : by_x) {
        std::sort(list.begin(), list.end());
    }
    for (const auto& [object, from, to] : sides) {
        const Point& a = surface.points[from];
        const Point& b = surface.points[to];
        const double length = (b - a).norm();
        if (length < kBeside) {
            faults.add("a side without length at point " + std::to_string(from));
            continue;
        }
        const auto& list = by_x.at(static_cast<ObjectId>(object));
        const double low = std::min(a.x(), b.x()) - kFlat;
        auto at = std::lower_bound(list.begin(), list.end(), std::pair(low, std::uint32_t{0}));
        for (; at != list.end() && at->first <= std::max(a.x(), b.x()) + kFlat; ++at) {
            const Point away = surface.points[at->second] - a;
            const double along = away.dot(b - a) / length;
            if (along > kFlat && along < length - kFlat &&
                away.cross(b - a).norm() / length <= kFlat) {
                faults.add(
                    "point " + std::to_string(at->second) + " is within the side from " +
                    std::to_string(from) + " to " + std::to_string(to)
                );
            }
        }
    }
}

namespace {

using Place = std::array<float, 3>;

struct Totals {
    double area = 0;
    double volume = 0;
};

// Positions are floats: how wrong sums of such triangles may be.
bool are_near(double a, double b) { return std::abs(a - b) <= 1e-4 * (1 + std::abs(a)); }

// `least_cosine`: of the angle between a triangle and the normals given for its corners.
Totals check_primitive(
    const Primitive& part, const std::string& what, double least_cosine, FaultList& faults
) {
    std::map<std::pair<Place, Place>, int> balance;
    Totals totals;
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
        std::array<Point, 3> corners;
        std::array<Place, 3> places = {};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& at = part.positions[part.indices[i + k]];
            corners[k] = Point(at.x, at.y, at.z);
            places[k] = {at.x, at.y, at.z};
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Place& from = places[k];
            const Place& to = places[(k + 1) % 3];
            balance[std::minmax(from, to)] += from < to ? 1 : -1;
        }
        const Point area = (corners[1] - corners[0]).cross(corners[2] - corners[0]) / 2;
        totals.area += area.norm();
        totals.volume += corners[0].dot(area) / 3;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& given = part.normals[part.indices[i + k]];
            const Point normal(given.x, given.y, given.z);
            if (area.norm() > 1e-3 && normal.dot(area.normalized()) < least_cosine) {
                faults.add("a triangle of " + what + " looks elsewhere than its normal");
            }
        }
    }
    for (const auto& [edge, sum] : balance) {
        if (sum != 0) {
            faults.add("the triangles of " + what + " are not closed");
        }
    }
    return totals;
}

}  // namespace

void check_scene(
    const continuous::Example& example,
    const Scene& scene,
    const std::vector<SpacePolygon>& polygons,
    FaultList& faults
) {
    // Shapes, which stand in for boxes, are smooth, and closed; how large they are is not known
    // here.
    std::set<std::uint32_t> of_shapes;
    // Decorations are closed, too, and are there besides the polygons; other tests know where.
    std::set<std::uint32_t> of_decorations;
    std::set<std::uint32_t> of_meshes;  // which are smooth, too
    for (const continuous::ObjectType& object : example.objects) {
        for (const continuous::Decoration& decoration : object.decorations) {
            const auto look =
                std::visit([](const auto& one) { return std::size_t{one.look}; }, decoration);
            const std::uint32_t material =
                look == continuous::kEmpty ? object.material : example.objects[look - 1].material;
            of_decorations.insert(material);
            if (std::holds_alternative<continuous::CornerDecoration>(decoration)) {
                of_meshes.insert(material);
            }
        }
        if (object.shape != nullptr) {
            of_shapes.insert(object.material);
        }
    }
    std::map<std::uint32_t, Totals> expected;
    for (const SpacePolygon& polygon : polygons) {
        Totals& totals = expected[example.objects[polygon.solid - 1].material];
        totals.area += polygon.area;
        totals.volume += polygon.offset * polygon.area / 3;
    }
    std::map<std::uint32_t, Totals> found;
    for (const Mesh& mesh : scene.kit->meshes) {
        for (const Primitive& part : mesh.primitives) {
            const std::string what = "material " + std::to_string(part.material);
            const bool is_smooth =
                of_shapes.contains(part.material) || of_meshes.contains(part.material);
            const double least_cosine = is_smooth ? 0.5 : 1 - 1e-4;
            const Totals totals = check_primitive(part, what, least_cosine, faults);
            found[part.material].area += totals.area;
            found[part.material].volume += totals.volume;
        }
    }
    for (const auto& [material, totals] : expected) {
        if (of_decorations.contains(material)) {
            if (found[material].area < totals.area * (1 - 1e-4) && !of_shapes.contains(material)) {
                faults.add("polygons of material " + std::to_string(material) + " are missing");
            }
            continue;
        }
        if (of_shapes.contains(material)) {
            if (found[material].volume <= 0 || found[material].volume > totals.volume * (1 + 1e-4)) {
                faults.add("shapes of material " + std::to_string(material) + " leave their boxes");
            }
            continue;
        }
        if (!are_near(totals.area, found[material].area) ||
            !are_near(totals.volume, found[material].volume)) {
            faults.add(
                "the triangles of material " + std::to_string(material) + " cover " +
                std::to_string(found[material].area) + " and enclose " +
                std::to_string(found[material].volume) + ", not " + std::to_string(totals.area) +
                " and " + std::to_string(totals.volume)
            );
        }
    }
}

}  // namespace modelsynth::testing
