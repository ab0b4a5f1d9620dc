#include "solver/continuous/decoration/placed_decorations.h"

#include "solver/continuous/decoration/contacts.h"
#include "solver/continuous/decoration/decoration_meshes.h"
#include "solver/continuous/decoration/face_choice.h"
#include "solver/continuous/decoration/mitres.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/surface/sides.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

namespace modelsynth::continuous {

namespace {

bool is_convex(const Side& side, const Side& twin) { return twin.outwards.dot(side.inwards) < 0; }

bool has_turn(bool is_convex, Turn wanted) {
    return wanted == Turn::kAny || (wanted == Turn::kConvex) == is_convex;
}

// What is decorated of one object.
class ObjectDecorator {
  public:
    ObjectDecorator(
        const Surface& surface,
        const PlacedShapes& shapes,
        const Contacts& contacts,
        std::span<const Point> normals,
        ObjectId object
    )
        : surface_(surface),
          contacts_(contacts),
          object_(object),
          sides_(sides_of(surface, normals, object)),
          free_parts_(sides_.size()) {
        is_bare_.reserve(sides_.size());
        for (const Side& side : sides_) {
            is_bare_.push_back(
                shapes.is_replaced[side.polygon] == 0 &&
                        surface.polygons[side.polygon].family != kNoFamily
                    ? 1
                    : 0
            );
        }
        find_corners();
    }

    void add(const EdgeDecoration& decoration, std::vector<Sweep>& sweeps) {
        MitredSweeps mitred(object_, decoration);
        for (std::size_t s = 0; s < sides_.size(); ++s) {
            if (const auto sides = chosen_edge(s, decoration)) {
                add_edge(*sides, mitred);
            }
            if (mitred.size() * 2 * decoration.profile.size() > kShapeTrianglesMax) {
                break;  // too many already; they need not fill the memory
            }
        }
        mitred.append_to(sweeps);
    }

    void add(const CornerDecoration& decoration, std::vector<PlacedMesh>& meshes) {
        const std::size_t count_max = kShapeTrianglesMax / triangle_count(*decoration.mesh);
        const std::size_t before = meshes.size();
        for (const std::vector<std::size_t>& corner : corners_) {
            if (meshes.size() - before > count_max) {
                break;  // too many already
            }
            std::vector<Point> normals;
            Point outwards = Point::Zero();
            bool is_convex_here = true;
            for (const std::size_t s : corner) {
                const Side& side = sides_[s];
                is_convex_here = is_convex_here && is_convex(side, sides_[side.twin]);
                if (is_chosen({FaceKind::kSide}, side.outwards)) {
                    outwards += side.outwards;
                }
                normals.push_back(side.outwards);
            }
            if (!has_turn(is_convex_here, decoration.turn) ||
                !are_chosen(decoration.faces, normals)) {
                continue;
            }
            // Asked last, since it takes longest.
            normals.clear();
            for (const std::size_t s : corner) {
                if (is_free_at_end(s)) {
                    normals.push_back(sides_[s].outwards);
                }
            }
            if (are_chosen(decoration.faces, normals)) {
                outwards.y() = 0;
                const bool is_turned = decoration.is_turned && outwards.norm() > 1e-9;
                meshes.push_back(
                    {object_,
                     &decoration,
                     surface_.points[sides_[corner.front()].to],
                     is_turned ? Point(outwards.normalized()) : Point(Point::UnitX())}
                );
            }
        }
    }

  private:
    using Pair = std::array<std::size_t, 2>;

    // Sides that come to one corner of one piece, in order round it. A polygon that comes to a
    // point twice has two corners there.
    void find_corners() {
        corner_of_.assign(sides_.size(), kNoSide);
        for (std::size_t first = 0; first < sides_.size(); ++first) {
            if (corner_of_[first] != kNoSide) {
                continue;
            }
            std::vector<std::size_t> corner;
            std::size_t s = first;
            while (s != kNoSide && corner_of_[s] == kNoSide) {
                corner_of_[s] = corners_.size();
                corner.push_back(s);
                s = sides_[sides_[s].next].twin;
            }
            check(s == first, "a surface that is open at a corner");
            corners_.push_back(std::move(corner));
        }
    }

    // The sides of an edge that is to be decorated, that of the first chosen face first. Of an
    // edge that fits either way round that face comes first along whose side one goes upwards, or
    // else east, or south.
    [[nodiscard]] std::optional<Pair> chosen_edge(std::size_t s, const EdgeDecoration& decoration)
        const {
        const std::size_t twin = sides_[s].twin;
        const Point along = surface_.points[sides_[s].to] - surface_.points[sides_[s].from];
        const double least = 1e-9 * along.norm();
        bool is_first = along.z() > 0;
        for (const int axis : {0, 1}) {
            is_first = std::abs(along[axis]) > least ? along[axis] > 0 : is_first;
        }
        if (!is_first || is_bare_[s] == 0 || is_bare_[twin] == 0 ||
            !has_turn(is_convex(sides_[s], sides_[twin]), decoration.turn)) {
            return std::nullopt;
        }
        for (const Pair& pair : {Pair{s, twin}, Pair{twin, s}}) {
            if (is_chosen(decoration.faces[0], sides_[pair[0]].outwards) &&
                is_chosen(decoration.faces[1], sides_[pair[1]].outwards)) {
                return pair;
            }
        }
        return std::nullopt;
    }

    void add_edge(const Pair& pair, MitredSweeps& mitred) {
        const Side& first = sides_[pair[0]];
        const Side& second = sides_[pair[1]];
        const Point& from = surface_.points[first.from];
        const Point& to = surface_.points[first.to];
        const double length = (to - from).norm();
        std::vector<SidePart> across = free_parts(pair[1]);
        for (SidePart& part : across) {
            part = {
                part.end < length ? length - part.end : 0,
                part.begin > 0 ? length - part.begin : length};
        }
        std::reverse(across.begin(), across.end());
        for (const SidePart& part : common_parts(free_parts(pair[0]), across)) {
            const bool is_from_start = part.begin <= 0;
            const bool is_to_end = part.end >= length;
            if (part.end - part.begin <= contacts_.tolerance()) {
                continue;
            }
            const Point along = (to - from) / length;
            DecoratedEdge edge;
            edge.polygons = {first.polygon, second.polygon};
            edge.normals = {first.outwards, second.outwards};
            edge.ends = {
                is_from_start ? from : Point(from + part.begin * along),
                is_to_end ? to : Point(from + part.end * along)};
            edge.corners = {
                is_from_start ? corner_of_[pair[1]] : kNoSide,
                is_to_end ? corner_of_[pair[0]] : kNoSide};
            // The profile's plane is seen from its other side where the edge is concave.
            if (!is_convex(first, second)) {
                std::swap(edge.ends[0], edge.ends[1]);
                std::swap(edge.corners[0], edge.corners[1]);
            }
            mitred.add(edge);
        }
    }

    const std::vector<SidePart>& free_parts(std::size_t s) {
        auto& known = free_parts_[s];
        if (!known) {
            known = contacts_.free_parts(sides_[s]);
        }
        return *known;
    }

    // Whether the polygon borders empty space in the corner in which a side ends.
    bool is_free_at_end(std::size_t s) {
        const std::size_t next = sides_[s].next;
        const Side& side = sides_[s];
        const double length = (surface_.points[side.to] - surface_.points[side.from]).norm();
        return is_bare_[s] != 0 && !free_parts(s).empty() && free_parts(s).back().end >= length &&
               !free_parts(next).empty() && free_parts(next).front().begin <= 0;
    }

    const Surface& surface_;
    const Contacts& contacts_;
    ObjectId object_;
    std::vector<Side> sides_;
    std::vector<std::optional<std::vector<SidePart>>> free_parts_;  // by side, as far as asked for
    std::vector<std::uint8_t> is_bare_;                             // by side
    std::vector<std::size_t> corner_of_;                            // by side: where it ends
    std::vector<std::vector<std::size_t>> corners_;
};

// The normals of the families, which are the same for all polygons of one.
std::vector<Point> exact_normals(std::span<const Point> of_families, const Surface& surface) {
    std::vector<Point> normals = normals_of(surface);
    for (std::size_t p = 0; p < normals.size(); ++p) {
        const SurfacePolygon& polygon = surface.polygons[p];
        if (polygon.family != kNoFamily) {
            normals[p] = (polygon.is_along_normal ? 1 : -1) * of_families[polygon.family];
        }
    }
    return normals;
}

bool has_all_twins(const std::vector<Side>& sides) {
    return std::all_of(sides.begin(), sides.end(), [](const Side& side) {
        return side.twin != kNoSide;
    });
}

// Of the sweeps and meshes from these numbers on.
std::size_t triangles_from(
    const PlacedDecorations& placed, std::size_t first_sweep, std::size_t first_mesh
) {
    std::size_t count = 0;
    for (std::size_t i = first_sweep; i < placed.sweeps.size(); ++i) {
        count += triangle_count(placed.sweeps[i]);
    }
    for (std::size_t i = first_mesh; i < placed.meshes.size(); ++i) {
        count += triangle_count(*placed.meshes[i].decoration->mesh);
    }
    return count;
}

}  // namespace

PlacedDecorations place_decorations(
    const Example& example,
    std::span<const Point> normals,
    const Surface& surface,
    const PlacedShapes& shapes
) {
    PlacedDecorations placed;
    const auto is_plain = [](const ObjectType& type) { return type.decorations.empty(); };
    if (std::all_of(example.objects.begin(), example.objects.end(), is_plain)) {
        return placed;
    }
    const std::vector<Point> of_polygons = exact_normals(normals, surface);
    const Contacts contacts(surface, of_polygons);
    std::size_t triangles = shapes.triangle_count;
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        if (is_plain(example.objects[i])) {
            continue;
        }
        const auto object = static_cast<ObjectId>(i + 1);
        if (!surface.is_closed && !has_all_twins(sides_of(surface, of_polygons, object))) {
            continue;
        }
        ObjectDecorator decorator(surface, shapes, contacts, of_polygons, object);
        for (const Decoration& decoration : example.objects[i].decorations) {
            const std::size_t sweeps = placed.sweeps.size();
            const std::size_t meshes = placed.meshes.size();
            if (const auto* edges = std::get_if<EdgeDecoration>(&decoration)) {
                decorator.add(*edges, placed.sweeps);
            } else {
                decorator.add(std::get<CornerDecoration>(decoration), placed.meshes);
            }
            triangles += triangles_from(placed, sweeps, meshes);
            if (triangles > kShapeTrianglesMax) {
                return {{}, {}, true};
            }
        }
    }
    return placed;
}

}  // namespace modelsynth::continuous
