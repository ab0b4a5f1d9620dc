#include "solver/continuous/shapes/placed_shapes.h"

#include "solver/continuous/shapes/cut_boxes.h"
#include "solver/continuous/surface/sides.h"
#include "solver/core/disjoint_sets.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

using Box3 = Eigen::AlignedBox3d;

constexpr double kTolerance = 1e-6;  // of a box

using Loop = std::vector<std::uint32_t>;

Point area_of(const Surface& surface, const Loop& loop) {
    const Point& origin = surface.points[loop.front()];
    Point area = Point::Zero();
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        area += (surface.points[loop[i]] - origin).cross(surface.points[loop[i + 1]] - origin) / 2;
    }
    return area;
}

// The parts of an object's surface that enclose one piece of it each.
class Pieces {
  public:
    Pieces(const Surface& surface, std::span<const Point> normals, ObjectId object)
        : pieces_(surface.polygons.size()) {
        for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
            if (surface.polygons[p].object == object) {
                polygons_.push_back(p);
            }
        }
        const std::vector<Side> sides = sides_of(surface, normals, object);
        for (const Side& side : sides) {
            if (side.twin != kNoSide) {
                pieces_.join(side.polygon, sides[side.twin].polygon);
            }
        }
    }

    // Polygons by piece, in the order of the first ones.
    [[nodiscard]] std::vector<std::vector<std::size_t>> all() {
        std::map<std::size_t, std::vector<std::size_t>> by_first;
        for (const std::size_t polygon : polygons_) {
            by_first[pieces_.find(polygon)].push_back(polygon);
        }
        std::vector<std::vector<std::size_t>> pieces;
        for (auto& [first, polygons] : by_first) {
            pieces.push_back(std::move(polygons));
        }
        return pieces;
    }

  private:
    std::vector<std::size_t> polygons_;  // of the object
    DisjointSets pieces_;                // of polygons
};

// The box of a piece that is so much of it.
std::optional<Box3> box_of(
    const Surface& surface, const std::vector<std::size_t>& piece, double share
) {
    Box3 box;
    double volume = 0;
    for (const std::size_t p : piece) {
        if (surface.polygons[p].family == kNoFamily) {
            return std::nullopt;  // the model's border cut it
        }
        for (const Loop& loop : surface.polygons[p].loops) {
            for (const std::uint32_t point : loop) {
                box.extend(surface.points[point]);
            }
            volume += area_of(surface, loop).dot(surface.points[loop.front()]) / 3;
        }
    }
    const bool is_whole =
        std::abs(volume - share * box.volume()) <= kTolerance * std::abs(box.volume());
    return is_whole && box.volume() > 0 ? std::optional(box) : std::nullopt;
}

Point face_normal(const Shape& shape, const Face& face) {
    Point area = Point::Zero();
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        area += (shape.corners[face[i]] - shape.corners[face[0]])
                    .cross(shape.corners[face[i + 1]] - shape.corners[face[0]]);
    }
    return area;  // as long as the face is large, so that large ones count more
}

}  // namespace

PlacedShapes place_shapes(const Example& example, const Surface& surface) {
    PlacedShapes placed;
    placed.is_replaced.assign(surface.polygons.size(), 0);
    std::size_t& triangles = placed.triangle_count;
    const std::vector<Point> normals = normals_of(surface);
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const ObjectType& type = example.objects[i];
        const auto object = static_cast<ObjectId>(i + 1);
        if (type.shape == nullptr) {
            continue;
        }
        std::set<std::tuple<float, float, float>> boxes;  // by their middles
        const auto key_of = [](const Box3& box) {
            const Eigen::Vector3f middle = box.center().cast<float>();
            return std::tuple(middle.x(), middle.y(), middle.z());
        };
        for (const std::vector<std::size_t>& piece : Pieces(surface, normals, object).all()) {
            if (const auto box = box_of(surface, piece, share_of_box(example, object))) {
                placed.shapes.push_back({object, {box->min(), box->max()}});
                boxes.insert(key_of(*box));
                triangles += triangle_count(*type.shape);
                for (const std::size_t polygon : piece) {
                    placed.is_replaced[polygon] = 1;
                }
            }
        }
        for (std::size_t r = 0; r < example.objects.size(); ++r) {
            if (example.objects[r].rest_of != object) {
                continue;
            }
            const auto rest = static_cast<ObjectId>(r + 1);
            for (const std::vector<std::size_t>& piece : Pieces(surface, normals, rest).all()) {
                const auto box = box_of(surface, piece, share_of_box(example, rest));
                if (box && boxes.contains(key_of(*box))) {
                    for (const std::size_t polygon : piece) {
                        placed.is_replaced[polygon] = 1;
                    }
                }
            }
        }
    }
    if (triangles > kShapeTrianglesMax) {
        return {{}, std::vector<std::uint8_t>(surface.polygons.size()), 0, true};
    }
    return placed;
}

std::size_t triangle_count(const Shape& shape) {
    std::size_t count = 0;
    for (const Face& face : shape.faces) {
        count += face.size() - 2;
    }
    return count;
}

std::vector<ShapeCorner> triangles_of(const Shape& shape, const Bounds& box) {
    Box3 own;
    for (const Point& corner : shape.corners) {
        own.extend(corner);
    }
    const Point scale = (box.max - box.min).cwiseQuotient(own.sizes());
    std::vector<Point> normals;
    std::vector<std::vector<std::size_t>> faces_at(shape.corners.size());
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
        normals.push_back(face_normal(shape, shape.faces[f]));
        for (const std::uint32_t corner : shape.faces[f]) {
            faces_at[corner].push_back(f);
        }
    }
    const double least_cosine = std::cos(shape.smooth_degrees * std::numbers::pi / 180);
    const auto corner_at = [&](std::size_t face, std::uint32_t corner) {
        // The face itself counts however its own cosine is rounded.
        Point normal = normals[face];
        for (const std::size_t other : faces_at[corner]) {
            const double cosine = normals[other].normalized().dot(normals[face].normalized());
            if (other != face && cosine >= least_cosine) {
                normal += normals[other];
            }
        }
        if (normal.norm() < kTolerance * normals[face].norm()) {  // they look opposite ways
            normal = normals[face];
        }
        return ShapeCorner{
            box.min + (shape.corners[corner] - own.min()).cwiseProduct(scale),
            normal.cwiseQuotient(scale).normalized()};
    };
    std::vector<ShapeCorner> triangles;
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
        const Face& face = shape.faces[f];
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            for (const std::uint32_t corner : {face[0], face[i], face[i + 1]}) {
                triangles.push_back(corner_at(f, corner));
            }
        }
    }
    return triangles;
}

std::vector<ShapeCorner> triangles_of(const Shape& shape) {
    Box3 own;
    for (const Point& corner : shape.corners) {
        own.extend(corner);
    }
    return triangles_of(shape, {own.min(), own.max()});
}

}  // namespace modelsynth::continuous
