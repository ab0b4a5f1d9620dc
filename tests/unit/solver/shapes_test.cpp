// What is round stands in for boxes: how they are cut, found again and replaced.

#include "solver/examples/solids/shapes.h"

#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/shapes/cut_boxes.h"
#include "solver/continuous/shapes/placed_shapes.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/lathe.h"
#include "tests/support/examples.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using examples::find_solids;
using examples::lathe;
using testing::RecordingObserver;

using Axes = std::array<bool, 3>;

constexpr std::array<std::array<double, 2>, 4> kCone = {{{0, 0}, {2, 0}, {1, 3}, {0, 3}}};

Example with_shape(const Axes& is_even, std::vector<Polyhedron> solids) {
    Example example;
    example.materials = {{"grass", {}}, {"round", {}}, {"wall", {}}};
    example.objects = {{"grass", 0}, {"round", 1, 3, lathe(kCone, 12, is_even)}, {"wall", 2}};
    example.ground = 1;
    example.polyhedra = std::move(solids);
    return example;
}

double volume_of(const Polyhedron& solid) {
    double volume = 0;
    for (const Face& face : solid.faces) {
        volume += area_vector(solid, face).dot(solid.corners[face.front()]) / 3;
    }
    return volume;
}

Eigen::AlignedBox3d bounds_of(const std::vector<Point>& points) {
    Eigen::AlignedBox3d bounds;
    for (const Point& point : points) {
        bounds.extend(point);
    }
    return bounds;
}

TEST(CutBoxes, GivesTwoSolidsThatFillTheBoxAndReachThroughAllOfIt) {
    for (const Axes& is_even :
         {Axes{true, false, true},
          Axes{true, true, false},
          Axes{false, true, true},
          Axes{true, true, true}}) {
        const Polyhedron whole = box(2, {1, 0, 2}, {5, 3, 4});
        Example example = with_shape(is_even, {whole, box(3, {8, 0, 0}, {9, 1, 1})});
        ASSERT_TRUE(find_shape_faults(example).empty());
        cut_boxes(example);
        EXPECT_TRUE(find_solid_faults(example).empty());
        ASSERT_EQ(example.objects.size(), 4U);
        EXPECT_EQ(example.objects[3].rest_of, 2);
        EXPECT_EQ(example.objects[3].material, 1U);
        EXPECT_EQ(example.objects[3].weight, 3);
        ASSERT_EQ(example.polyhedra.size(), 3U);
        const Polyhedron& first = example.polyhedra[0];
        const Polyhedron& rest = example.polyhedra[1];
        EXPECT_EQ(first.object, 2);
        EXPECT_EQ(rest.object, 4);
        EXPECT_NEAR(volume_of(first) + volume_of(rest), 24, 1e-12);
        EXPECT_NEAR(volume_of(first), share_of_box(example, 2) * 24, 1e-12);
        EXPECT_NEAR(volume_of(rest), share_of_box(example, 4) * 24, 1e-12);
        for (const Polyhedron* part : {&first, &rest}) {
            const Eigen::AlignedBox3d bounds = bounds_of(part->corners);
            EXPECT_EQ(bounds.min(), Point(1, 0, 2));
            EXPECT_EQ(bounds.max(), Point(5, 3, 4));
        }
        const Example again = with_whole_boxes(example);
        EXPECT_EQ(again.objects.size(), 3U);
        ASSERT_EQ(again.polyhedra.size(), 2U);
        EXPECT_NEAR(volume_of(again.polyhedra[0]), 24, 1e-12);
        EXPECT_TRUE(find_solid_faults(again).empty());
    }
}

TEST(CutBoxes, LeavesBoxesThatMayGrowAsTheyLikeWhole) {
    Example example = with_shape({}, {box(2, {1, 0, 2}, {5, 3, 4})});
    cut_boxes(example);
    EXPECT_EQ(example.objects.size(), 3U);
    EXPECT_EQ(example.polyhedra.size(), 1U);
    EXPECT_EQ(share_of_box(example, 2), 1);
}

TEST(ShapeFaults, TellTheirPlace) {
    const auto pointers = [](const Example& example) {
        std::vector<std::string> all;
        for (const Fault& fault : find_shape_faults(example)) {
            all.push_back(fault.pointer);
        }
        return all;
    };
    using Pointers = std::vector<std::string>;
    const Polyhedron one = box(2, {0, 0, 0}, {2, 2, 2});
    EXPECT_EQ(pointers(with_shape({}, {one, box(2, {3, 0, 0}, {4, 1, 1})})), Pointers{});
    EXPECT_EQ(pointers(with_shape({true, false, false}, {one})), Pointers{"/objects/1/shape/even"});
    EXPECT_EQ(
        pointers(with_shape({}, {one, box(2, {2, 0, 1}, {4, 1, 3})})), Pointers{"/polyhedra/1"}
    );
    EXPECT_EQ(
        pointers(with_shape({}, {one, box(2, {2, 2, 2}, {4, 4, 4})})), Pointers{"/polyhedra/1"}
    );
    EXPECT_EQ(
        pointers(with_shape({}, {examples::hip_roof(2, {0, 0, 0}, {4, 0, 4})})),
        Pointers{"/polyhedra/0"}
    );
    Example example = with_shape({}, {one});
    example.ground = 2;
    EXPECT_EQ(pointers(example), Pointers{"/objects/1/shape"});
    example = with_shape({}, {one});
    auto flat = std::make_shared<Shape>(*example.objects[1].shape);
    for (Point& corner : flat->corners) {
        corner.y() = 1;
    }
    example.objects[1].shape = flat;
    EXPECT_EQ(pointers(example), Pointers{"/objects/1/shape/vertices"});
}

// Polygons of solids, with one point for one place.
Surface surface_of(const std::vector<Polyhedron>& solids) {
    Surface surface;
    std::map<std::array<double, 3>, std::uint32_t> numbers;
    for (const Polyhedron& solid : solids) {
        for (const Face& face : solid.faces) {
            SurfacePolygon& polygon = surface.polygons.emplace_back();
            polygon.object = solid.object;
            std::vector<std::uint32_t>& loop = polygon.loops.emplace_back();
            for (const std::uint32_t corner : face) {
                const Point& p = solid.corners[corner];
                const auto next = static_cast<std::uint32_t>(surface.points.size());
                const auto [at, is_new] = numbers.try_emplace({p.x(), p.y(), p.z()}, next);
                if (is_new) {
                    surface.points.push_back(p);
                }
                loop.push_back(at->second);
            }
        }
    }
    return surface;
}

TEST(PlacedShapes, AreOneForEachBoxAlsoWhereBoxesTouchAtEdgesAndCorners) {
    for (const Axes& is_even : {Axes{}, Axes{true, false, true}, Axes{true, true, true}}) {
        Example example = with_shape(
            is_even,
            {box(2, {0, 0, 0}, {2, 2, 2}),
             box(2, {2, 0, 2}, {4, 2, 4}),  // along an edge
             box(2, {4, 2, 4}, {6, 4, 6}),  // at a corner
             box(3, {2, 0, 0}, {3, 1, 1})}
        );
        cut_boxes(example);
        const Surface surface = surface_of(example.polyhedra);
        const PlacedShapes placed = place_shapes(example, surface);
        ASSERT_EQ(placed.shapes.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            const double low = 2.0 * static_cast<double>(i);
            EXPECT_EQ(placed.shapes[i].object, 2);
            EXPECT_EQ(placed.shapes[i].box.min.x(), low);
            EXPECT_EQ(placed.shapes[i].box.max, placed.shapes[i].box.min + Point(2, 2, 2));
        }
        for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
            EXPECT_EQ(placed.is_replaced[p] != 0, surface.polygons[p].object != 3);
        }
    }
}

TEST(PlacedShapes, LeaveWhatIsNoBoxAsItIs) {
    Example example = with_shape({}, {});
    const Surface surface =
        surface_of({examples::hip_roof(2, {0, 0, 0}, {4, 0, 4}), box(2, {6, 0, 0}, {8, 1, 1})});
    const PlacedShapes placed = place_shapes(example, surface);
    ASSERT_EQ(placed.shapes.size(), 1U);
    EXPECT_EQ(placed.shapes[0].box.min.x(), 6);
    EXPECT_EQ(std::count(placed.is_replaced.begin(), placed.is_replaced.end(), 1), 6);
}

TEST(PlacedShapes, AreBoxesWhereTheyWouldBeTooManyTriangles) {
    const Example example = with_shape({}, {});  // 12 segments: 48 triangles
    std::vector<Polyhedron> boxes;
    for (int x = 0; x < 21'000; ++x) {
        boxes.push_back(box(2, {2.0 * x, 0, 0}, {2.0 * x + 1, 1, 1}));
        if (boxes.size() == 1 || x == 20'999) {
            const PlacedShapes placed = place_shapes(example, surface_of(boxes));
            EXPECT_EQ(placed.are_too_many, boxes.size() > 1);
            EXPECT_EQ(placed.shapes.size(), placed.are_too_many ? 0U : 1U);
        }
    }
}

TEST(ShapeTriangles, LieOverTheBoxAndLookOutwards) {
    const auto shape = lathe(kCone, 12, {});
    const Bounds bounds = {{1, 2, 3}, {3, 8, 9}};
    const std::vector<ShapeCorner> corners = triangles_of(*shape, bounds);
    ASSERT_EQ(corners.size(), 3U * (12 + 2 * 12 + 12));
    std::vector<Point> places;
    double volume = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const Point across = (corners[i + 1].place - corners[i].place)
                                 .cross(corners[i + 2].place - corners[i].place);
        volume += across.dot(corners[i].place) / 6;
        for (std::size_t k = i; k < i + 3; ++k) {
            places.push_back(corners[k].place);
            EXPECT_NEAR(corners[k].normal.norm(), 1, 1e-12);
            EXPECT_GT(corners[k].normal.dot(across), 0);
        }
    }
    EXPECT_TRUE(bounds_of(places).min().isApprox(bounds.min, 1e-12));
    EXPECT_TRUE(bounds_of(places).max().isApprox(bounds.max, 1e-12));
    // A frustum of a polygon of 12 sides, of radii 2 and 1 and height 3, stretched.
    const double base = 0.5 * 12 * std::sin(std::acos(-1.0) / 6);
    const double frustum = 3 * base * (4 + 2 + 1) / 3;
    EXPECT_NEAR(volume, frustum * (2.0 / 4) * (6.0 / 3) * (6.0 / 4), 1e-9);
}

TEST(ShapeTriangles, AreSmoothUpToTheAngle) {
    const auto distinct_normals = [](double degrees) {
        Shape shape = *lathe(kCone, 12, {});
        shape.smooth_degrees = degrees;
        std::set<std::array<int, 3>> normals;
        for (const ShapeCorner& corner : triangles_of(shape, {{0, 0, 0}, {4, 3, 4}})) {
            const Point n = 1e6 * corner.normal;
            normals.insert(
                {static_cast<int>(std::lround(n.x())),
                 static_cast<int>(std::lround(n.y())),
                 static_cast<int>(std::lround(n.z()))}
            );
        }
        return normals.size();
    };
    EXPECT_EQ(distinct_normals(10), 2U + 12);  // flat: bottom, top and each side
    EXPECT_EQ(distinct_normals(40), 2U + 12);  // the sides run into each other at their edges
    Shape flat = *lathe(kCone, 12, {});
    flat.smooth_degrees = 40;
    std::map<std::array<int, 3>, std::set<double>> at;
    for (const ShapeCorner& corner : triangles_of(flat, {{0, 0, 0}, {4, 3, 4}})) {
        const Point p = 1e3 * corner.place;
        at[{static_cast<int>(std::lround(p.x())),
            static_cast<int>(std::lround(p.y())),
            static_cast<int>(std::lround(p.z()))}]
            .insert(std::round(1e6 * corner.normal.x()));
    }
    for (const auto& [place, normals] : at) {
        EXPECT_LE(normals.size(), 2U);  // of a ring: that of the sides and that of the cap
    }
}

TEST(ShapeTriangles, HaveTheNormalsOfTheirFacesWhereNothingIsSmooth) {
    for (const double degrees : {0.0, 180.0}) {
        Shape shape = *lathe(kCone, 12, {});
        shape.smooth_degrees = degrees;
        const std::vector<ShapeCorner> corners = triangles_of(shape, {{0, 0, 0}, {5, 7, 11}});
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const Point& a = corners[i].place;
            const Point face =
                (corners[i + 1].place - a).cross(corners[i + 2].place - a).normalized();
            for (std::size_t j = i; j < i + 3; ++j) {
                EXPECT_NEAR(corners[j].normal.norm(), 1, 1e-12);
                EXPECT_TRUE(degrees > 0 || corners[j].normal.isApprox(face, 1e-9)) << i;
            }
        }
    }
    // Two sheets with nothing between them: all that is at a corner sums up to nothing.
    Shape sheets;
    sheets.corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    sheets.faces = {{0, 1, 2}, {0, 2, 1}};
    sheets.smooth_degrees = 180;
    for (const ShapeCorner& corner : triangles_of(sheets)) {
        EXPECT_NEAR(corner.normal.norm(), 1, 1e-12);
    }
}

TEST(BuiltInDomes, AreTrueToShapeInEverySize) {
    const auto reading = find_solids("domes");
    const Example& example = reading->example();
    const ObjectId dome = find_object(example, "dome");
    const ObjectId tower = find_object(example, "tower");
    std::set<double> widths;
    std::set<double> heights;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        Parameters parameters;
        parameters.size = {28, 12, 28};
        parameters = fill_defaults(parameters, example);
        const Problem problem = make_problem(reading, parameters).value();
        RecordingObserver observer;
        const Synthesis made = synthesise(problem, parameters, seed, observer, {}).value();
        const Surface surface = make_surface(problem, made.labels);
        const PlacedShapes placed = place_shapes(example, surface);
        EXPECT_FALSE(placed.are_too_many);
        for (const PlacedShape& one : placed.shapes) {
            const Point size = one.box.max - one.box.min;
            EXPECT_NEAR(size.x(), size.z(), 1e-9);
            if (one.object == dome) {
                EXPECT_NEAR(size.y(), size.x() / 2, 1e-9);
                widths.insert(std::round(size.x() * 1e6));
            } else {
                EXPECT_EQ(one.object, tower);
                heights.insert(std::round(size.y() * 1e6));
            }
        }
        for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
            const ObjectType& type = example.objects[surface.polygons[p].object - 1U];
            EXPECT_EQ(placed.is_replaced[p] != 0, type.shape != nullptr || type.rest_of != kEmpty);
        }
        // A patch of half the model has the half of its shapes, the whole has all of them.
        const auto triangles = [](const Scene& scene) {
            std::size_t count = 0;
            for (const Mesh& mesh : scene.kit->meshes) {
                for (const Primitive& primitive : mesh.primitives) {
                    count += primitive.indices.size() / 3;
                }
            }
            return count;
        };
        const std::size_t all = triangles(make_scene(*reading, surface));
        EXPECT_GT(all, placed.shapes.size() * 100);
        const std::size_t west =
            triangles(make_scene(*reading, surface, {{0, -1, 0}, {14, 12, 28}}));
        EXPECT_LT(west, all);
        EXPECT_GT(west, 0U);
    }
    EXPECT_GT(widths.size(), 1U);
    EXPECT_GT(heights.size(), 1U);
}

}  // namespace
}  // namespace modelsynth::continuous
