#include "solver/continuous/scene.h"

#include "solver/continuous/decoration/decoration_meshes.h"
#include "solver/continuous/decoration/placed_decorations.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/shapes/placed_shapes.h"
#include "solver/continuous/triangulation/triangulation.h"

#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// How a face lies in space, and two directions in its plane: to the right and up, seen from
// outside.
struct FaceAxes {
    Point normal;
    Point right;
    Point up;
    double repeat_m = 1;  // how wide the picture is
};

FaceAxes axes_of(const Point& normal) {
    const bool is_flat = std::abs(normal.y()) > 1 - 1e-9;
    const Point right = is_flat ? Point(Point::UnitX()) : Point::UnitY().cross(normal).normalized();
    return {normal, right, normal.cross(right)};
}

// A convex polygon cut to a box (Sutherland and Hodgman 1974).
std::vector<Point> clipped(std::vector<Point> polygon, const Bounds& box) {
    for (int side = 0; side < 6 && !polygon.empty(); ++side) {
        const int axis = side / 2;
        const double limit = side % 2 == 0 ? box.min[axis] : box.max[axis];
        const double sign = side % 2 == 0 ? 1 : -1;
        std::vector<Point> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point& a = polygon[i];
            const Point& b = polygon[(i + 1) % polygon.size()];
            const double inside_a = sign * (a[axis] - limit);
            const double inside_b = sign * (b[axis] - limit);
            if (inside_a >= 0) {
                kept.push_back(a);
            }
            if ((inside_a > 0 && inside_b < 0) || (inside_a < 0 && inside_b > 0)) {
                kept.push_back(a + inside_a / (inside_a - inside_b) * (b - a));
            }
        }
        polygon = std::move(kept);
    }
    return polygon;
}

class MeshBuilder {
  public:
    MeshBuilder(const Example& example, const std::string& name) {
        kit_->materials = example.materials;
        mesh_.name = name;
        primitive_of_material_.assign(example.materials.size(), kNone);
    }

    // `part`: what lies outside of it is cut off; null: nothing is.
    void add(
        std::uint32_t material,
        std::span<const Point> points,
        const std::vector<std::vector<std::uint32_t>>& loops,
        const Point& normal,
        const Bounds* part = nullptr
    ) {
        Primitive& primitive = primitive_of(material);
        FaceAxes axes = axes_of(normal);
        if (const auto& texture = kit_->materials[material].texture) {
            axes.repeat_m = texture->repeat_m;
        }
        std::vector<Point> corners;
        std::vector<Point2> flat;
        std::vector<Loop> numbered;
        std::unordered_map<std::uint32_t, std::uint32_t> numbers;
        for (const std::vector<std::uint32_t>& loop : loops) {
            Loop& own = numbered.emplace_back();
            for (const std::uint32_t point : loop) {
                const auto next = static_cast<std::uint32_t>(flat.size());
                const auto [at, is_new] = numbers.try_emplace(point, next);
                if (is_new) {
                    corners.push_back(points[point]);
                    flat.push_back({points[point].dot(axes.right), points[point].dot(axes.up)});
                }
                own.push_back(at->second);
            }
        }
        const std::span<const Loop> holes(numbered.data() + 1, numbered.size() - 1);
        const auto triangles = triangulate(flat, numbered.front(), holes);
        if (part != nullptr) {
            for (const auto& [a, b, c] : triangles) {
                add_fan(
                    primitive,
                    clipped({corners[a], corners[b], corners[c]}, *part),
                    axes,
                    [&axes](const Point& /*place*/) { return axes.normal; }
                );
            }
            return;
        }
        const auto first = static_cast<std::uint32_t>(primitive.positions.size());
        for (const Point& corner : corners) {
            add_vertex(primitive, corner, axes, axes.normal);
        }
        for (const auto& triangle : triangles) {
            for (const std::uint32_t corner : triangle) {
                primitive.indices.push_back(first + corner);
            }
        }
    }

    // Three corners after each other.
    void add_triangles(
        std::uint32_t material, std::span<const ShapeCorner> corners, const Bounds* part
    ) {
        Primitive& primitive = primitive_of(material);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const std::span<const ShapeCorner, 3> triangle(&corners[i], 3);
            std::vector<Point> places = {triangle[0].place, triangle[1].place, triangle[2].place};
            const Point across = (places[1] - places[0]).cross(places[2] - places[0]);
            FaceAxes axes = axes_of(across.normalized());
            if (const auto& texture = kit_->materials[material].texture) {
                axes.repeat_m = texture->repeat_m;
            }
            const auto normal_at = [&](const Point& place) {
                Point normal = Point::Zero();
                for (std::size_t k = 0; k < 3; ++k) {
                    const Point& a = triangle[(k + 1) % 3].place;
                    const Point& b = triangle[(k + 2) % 3].place;
                    const double share = (a - place).cross(b - place).dot(across);
                    normal += share * triangle[k].normal;
                }
                return normal.normalized();
            };
            if (part != nullptr) {
                places = clipped(std::move(places), *part);
            }
            add_fan(primitive, places, axes, normal_at);
        }
    }

    Scene finish() {
        // Of a part, all that has a material may have been cut off.
        std::erase_if(mesh_.primitives, [](const Primitive& primitive) {
            return primitive.indices.empty();
        });
        Scene scene;
        if (mesh_.primitives.empty()) {
            return scene;  // glTF has no meshes without parts
        }
        kit_->meshes.push_back(std::move(mesh_));
        scene.kit = std::move(kit_);
        scene.names = {scene.kit->meshes.front().name};
        scene.groups.push_back({"", {Instance{}}});
        return scene;
    }

  private:
    static constexpr std::size_t kNone = ~std::size_t{0};

    static void add_vertex(
        Primitive& primitive, const Point& point, const FaceAxes& axes, const Point& normal
    ) {
        const auto rounded = [](const Point& p) {
            return Vec3{
                static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
        };
        primitive.positions.push_back(rounded(point));
        primitive.normals.push_back(rounded(normal));
        primitive.colors.push_back({255, 255, 255});
        primitive.texture_coordinates.push_back(
            {static_cast<float>(point.dot(axes.right) / axes.repeat_m),
             static_cast<float>(-point.dot(axes.up) / axes.repeat_m)}
        );
    }

    template <class NormalAt>
    static void add_fan(
        Primitive& primitive,
        const std::vector<Point>& polygon,
        const FaceAxes& axes,
        NormalAt normal_at
    ) {
        if (polygon.size() < 3) {
            return;  // it only touched the box
        }
        const auto first = static_cast<std::uint32_t>(primitive.positions.size());
        for (const Point& corner : polygon) {
            add_vertex(primitive, corner, axes, normal_at(corner));
        }
        for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) {
            for (const std::uint32_t corner : {0U, i, i + 1}) {
                primitive.indices.push_back(first + corner);
            }
        }
    }

    Primitive& primitive_of(std::uint32_t material) {
        std::size_t& number = primitive_of_material_[material];
        if (number == kNone) {
            number = mesh_.primitives.size();
            mesh_.primitives.emplace_back().material = material;
        }
        return mesh_.primitives[number];
    }

    std::shared_ptr<Kit> kit_ = std::make_shared<Kit>();
    Mesh mesh_;
    std::vector<std::size_t> primitive_of_material_;
};

// Of a part of the model what has its place there, and that whole.
void draw_decorations(
    const Example& example,
    const PlacedDecorations& decorations,
    const Bounds* part,
    MeshBuilder& builder
) {
    const auto material_of = [&example](ObjectId object, ObjectId look) {
        return example.objects[(look == kEmpty ? object : look) - 1U].material;
    };
    for (const Sweep& sweep : decorations.sweeps) {
        if (part != nullptr && !is_in_part(place_of(sweep), *part)) {
            continue;
        }
        const std::uint32_t material = material_of(sweep.object, sweep.decoration->look);
        const SweptMesh mesh = mesh_of(sweep);
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            builder.add(material, mesh.corners, {mesh.faces[f]}, mesh.normals[f]);
        }
    }
    for (const PlacedMesh& mesh : decorations.meshes) {
        if (part == nullptr || is_in_part(mesh.at, *part)) {
            const std::uint32_t material = material_of(mesh.object, mesh.decoration->look);
            builder.add_triangles(material, triangles_of(mesh), nullptr);
        }
    }
}

Scene draw(const ExampleReading& reading, const Surface& surface, const Bounds* part) {
    const Example& example = reading.example();
    MeshBuilder builder(example, "model");
    const PlacedShapes placed = place_shapes(example, surface);
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        const SurfacePolygon& polygon = surface.polygons[p];
        if (placed.is_replaced[p] != 0) {
            continue;
        }
        Point normal;
        if (polygon.family != kNoFamily) {
            normal = (polygon.is_along_normal ? 1 : -1) * reading.topes().normals()[polygon.family];
        } else {
            normal = area_vector(surface.points, polygon.loops.front()).normalized();
        }
        builder.add(
            example.objects[polygon.object - 1U].material,
            surface.points,
            polygon.loops,
            normal,
            part
        );
    }
    for (const PlacedShape& one : placed.shapes) {
        const ObjectType& object = example.objects[one.object - 1U];
        builder.add_triangles(object.material, triangles_of(*object.shape, one.box), part);
    }
    draw_decorations(
        example,
        place_decorations(example, reading.topes().normals(), surface, placed),
        part,
        builder
    );
    return builder.finish();
}

}  // namespace

Scene make_scene(const ExampleReading& reading, const Surface& surface) {
    return draw(reading, surface, nullptr);
}

Scene make_scene(const ExampleReading& reading, const Surface& surface, const Bounds& part) {
    return draw(reading, surface, &part);
}

Scene make_example_scene(const ExampleReading& reading) {
    const Example& example = reading.example();
    MeshBuilder builder(example, "example");
    for (const Polyhedron& solid : example.polyhedra) {
        const ObjectType& object = example.objects[solid.object - 1U];
        if (object.rest_of != kEmpty) {
            continue;
        }
        if (object.shape != nullptr) {
            Eigen::AlignedBox3d box;
            for (const Point& corner : solid.corners) {
                box.extend(corner);
            }
            builder.add_triangles(
                object.material, triangles_of(*object.shape, {box.min(), box.max()}), nullptr
            );
            continue;
        }
        for (const Face& face : solid.faces) {
            builder.add(
                example.objects[solid.object - 1U].material,
                solid.corners,
                {face},
                area_vector(solid, face).normalized()
            );
        }
    }
    return builder.finish();
}

}  // namespace modelsynth::continuous
