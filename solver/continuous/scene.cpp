#include "solver/continuous/scene.h"

#include "solver/continuous/triangulation.h"

#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// Two directions in a face's plane: to the right and up, seen from outside.
struct FaceAxes {
    Point right;
    Point up;
};

FaceAxes axes_of(const Point& normal) {
    const bool is_flat = std::abs(normal.y()) > 1 - 1e-9;
    const Point right = is_flat ? Point(Point::UnitX()) : Point::UnitY().cross(normal).normalized();
    return {right, normal.cross(right)};
}

class MeshBuilder {
  public:
    MeshBuilder(const Example& example, const std::string& name) {
        kit_->materials = example.materials;
        mesh_.name = name;
        part_of_material_.assign(example.materials.size(), kNone);
    }

    void add(
        std::uint32_t material,
        std::span<const Point> points,
        const std::vector<std::vector<std::uint32_t>>& loops,
        const Point& normal
    ) {
        Primitive& part = part_of(material);
        const FaceAxes axes = axes_of(normal);
        std::vector<Point2> flat;
        std::vector<Loop> numbered;
        std::unordered_map<std::uint32_t, std::uint32_t> numbers;
        const auto first = static_cast<std::uint32_t>(part.positions.size());
        for (const std::vector<std::uint32_t>& loop : loops) {
            Loop& own = numbered.emplace_back();
            for (const std::uint32_t point : loop) {
                const auto next = static_cast<std::uint32_t>(flat.size());
                const auto [at, is_new] = numbers.try_emplace(point, next);
                if (is_new) {
                    const Point& p = points[point];
                    flat.push_back({p.dot(axes.right), p.dot(axes.up)});
                    part.positions.push_back(
                        {static_cast<float>(p.x()),
                         static_cast<float>(p.y()),
                         static_cast<float>(p.z())}
                    );
                    part.normals.push_back(
                        {static_cast<float>(normal.x()),
                         static_cast<float>(normal.y()),
                         static_cast<float>(normal.z())}
                    );
                    part.colors.push_back({255, 255, 255});
                }
                own.push_back(at->second);
            }
        }
        const std::span<const Loop> holes(numbered.data() + 1, numbered.size() - 1);
        for (const auto& triangle : triangulate(flat, numbered.front(), holes)) {
            for (const std::uint32_t corner : triangle) {
                part.indices.push_back(first + corner);
            }
        }
    }

    Scene finish() {
        kit_->meshes.push_back(std::move(mesh_));
        Scene scene;
        scene.kit = std::move(kit_);
        scene.names = {scene.kit->meshes.front().name};
        scene.groups.push_back({"", {Instance{}}});
        return scene;
    }

  private:
    static constexpr std::size_t kNone = ~std::size_t{0};

    Primitive& part_of(std::uint32_t material) {
        std::size_t& part = part_of_material_[material];
        if (part == kNone) {
            part = mesh_.primitives.size();
            mesh_.primitives.emplace_back().material = material;
        }
        return mesh_.primitives[part];
    }

    std::shared_ptr<Kit> kit_ = std::make_shared<Kit>();
    Mesh mesh_;
    std::vector<std::size_t> part_of_material_;
};

}  // namespace

Scene make_scene(const ExampleReading& reading, const Surface& surface) {
    const Example& example = reading.example();
    MeshBuilder builder(example, "model");
    for (const SurfacePolygon& polygon : surface.polygons) {
        Point normal;
        if (polygon.family != kNoFamily) {
            normal = (polygon.is_along_normal ? 1 : -1) * reading.topes().normals()[polygon.family];
        } else {
            const std::vector<std::uint32_t>& loop = polygon.loops.front();
            const Point& origin = surface.points[loop[0]];
            normal = (surface.points[loop[1]] - origin)
                         .cross(surface.points[loop[2]] - origin)
                         .normalized();
        }
        builder.add(
            example.objects[polygon.object - 1U].material, surface.points, polygon.loops, normal
        );
    }
    return builder.finish();
}

Scene make_example_scene(const ExampleReading& reading) {
    const Example& example = reading.example();
    MeshBuilder builder(example, "example");
    for (const Polyhedron& solid : example.polyhedra) {
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
