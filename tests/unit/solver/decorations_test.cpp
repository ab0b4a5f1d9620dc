// Mouldings along edges and meshes at corners: where they are, and that what is swept is closed.

#include "solver/continuous/decoration/decoration_meshes.h"
#include "solver/continuous/decoration/placed_decorations.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
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
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using testing::RecordingObserver;

constexpr FaceChoice kAny = {FaceKind::kAny};
constexpr FaceChoice kUp = {FaceKind::kUp};
constexpr FaceChoice kDown = {FaceKind::kDown};
constexpr FaceChoice kSide = {FaceKind::kSide};
constexpr FaceChoice kSlope = {FaceKind::kSlope};

// From 0.2 below a roof to 0.1 above it, and from 0.1 within a wall to 0.3 outside.
const std::vector<ProfilePoint> kBand = {{-0.2, -0.1}, {0.1, -0.1}, {0.1, 0.3}, {-0.2, 0.3}};

EdgeDecoration cornice() { return {{kUp, kSide}, Turn::kConvex, kBand}; }

std::shared_ptr<const Shape> unit_cube() {
    const Polyhedron cube = box(1, {0, 0, 0}, {1, 1, 1});
    return std::make_shared<Shape>(Shape{cube.corners, cube.faces});
}

Example example_of(std::vector<Polyhedron> solids) {
    Example example;
    example.materials = {{"wall", {}}, {"other", {}}};
    example.objects = {{"wall", 0}, {"other", 1}};
    example.polyhedra = std::move(solids);
    return example;
}

// Polygons of solids, with one point for one place.
struct Model {
    explicit Model(const std::vector<Polyhedron>& solids) {
        std::map<std::array<double, 3>, std::uint32_t> numbers;
        for (const Polyhedron& solid : solids) {
            for (const Face& face : solid.faces) {
                SurfacePolygon& polygon = surface.polygons.emplace_back();
                polygon.object = solid.object;
                add_family(polygon, area_vector(solid, face).normalized());
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
    }

    [[nodiscard]] PlacedDecorations placed(const Example& example) const {
        PlacedShapes shapes;
        shapes.is_replaced.assign(surface.polygons.size(), 0);
        return place_decorations(example, normals, surface, shapes);
    }

    Surface surface;
    std::vector<Point> normals;

  private:
    void add_family(SurfacePolygon& polygon, const Point& normal) {
        for (std::size_t i = 0; i <= normals.size(); ++i) {
            if (i == normals.size()) {
                normals.push_back(normal);
            }
            const double cosine = normals[i].dot(normal);
            if (std::abs(cosine) > 1 - 1e-9) {
                polygon.family = static_cast<std::uint8_t>(i);
                polygon.is_along_normal = cosine > 0;
                return;
            }
        }
    }
};

// What is swept, all together.
struct Swept {
    std::size_t count = 0;
    std::size_t triangles = 0;
    std::size_t mitres = 0;
    double volume = 0;
    Eigen::AlignedBox3d box;
};

using Place = std::array<double, 3>;

Place place(const Point& point) { return {point.x(), point.y(), point.z()}; }

// Expects flat faces that look outwards, and every edge of them as often one way as the other.
Swept check_closed(const std::vector<Sweep>& sweeps) {
    Swept all;
    std::map<std::pair<Place, Place>, int> balance;
    for (const Sweep& sweep : sweeps) {
        const SweptMesh mesh = mesh_of(sweep);
        ++all.count;
        all.triangles += triangle_count(sweep);
        all.mitres += (sweep.ends[0].is_mitred ? 1U : 0U) + (sweep.ends[1].is_mitred ? 1U : 0U);
        std::size_t triangles = 0;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const Face& face = mesh.faces[f];
            triangles += face.size() - 2;
            Point area = Point::Zero();
            for (std::size_t i = 0; i < face.size(); ++i) {
                const Point& a = mesh.corners[face[i]];
                const Point& b = mesh.corners[face[(i + 1) % face.size()]];
                EXPECT_NEAR((a - mesh.corners[face[0]]).dot(mesh.normals[f]), 0, 1e-9);
                ++balance[{place(a), place(b)}];
                --balance[{place(b), place(a)}];
                area += a.cross(b) / 2;
            }
            EXPECT_NEAR(area.normalized().dot(mesh.normals[f]), 1, 1e-9);
            all.volume += area.dot(mesh.corners[face[0]]) / 3;
        }
        EXPECT_EQ(triangles, triangle_count(sweep));
        for (const Point& corner : mesh.corners) {
            all.box.extend(corner);
        }
    }
    for (const auto& [edge, sum] : balance) {
        EXPECT_EQ(sum, 0);
    }
    return all;
}

Swept swept(const std::vector<Polyhedron>& solids, const EdgeDecoration& decoration) {
    Example example = example_of(solids);
    example.objects[0].decorations = {decoration};
    return check_closed(Model(solids).placed(example).sweeps);
}

std::vector<PlacedMesh> meshes(const Example& example) {
    return Model(example.polyhedra).placed(example).meshes;
}

// An L of 4 by 4 metres with arms 2 metres wide.
Polyhedron l_shape() {
    return examples::prism_upwards(1, {{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, 0, 2);
}

TEST(Cornice, GoesRoundABoxInMitres) {
    const Swept ring = swept({box(1, {0, 0, 0}, {4, 2, 3})}, cornice());
    EXPECT_EQ(ring.count, 4U);
    EXPECT_EQ(ring.mitres, 8U);
    EXPECT_EQ(ring.triangles, 4U * 8);
    EXPECT_TRUE(ring.box.min().isApprox(Point(-0.3, 1.8, -0.3), 1e-12));
    EXPECT_TRUE(ring.box.max().isApprox(Point(4.3, 2.1, 3.3), 1e-12));
    EXPECT_NEAR(ring.volume, 0.3 * (4.6 * 3.6 - 3.8 * 2.8), 1e-12);
}

TEST(Cornice, IsTheSameWithItsFacesOrItsProfileTheOtherWayRound) {
    EdgeDecoration turned = cornice();
    std::swap(turned.faces[0], turned.faces[1]);
    for (ProfilePoint& point : turned.profile) {
        std::swap(point[0], point[1]);
    }
    const Swept ring = swept({box(1, {0, 0, 0}, {4, 2, 3})}, turned);
    EXPECT_EQ(ring.mitres, 8U);
    EXPECT_NEAR(ring.volume, 0.3 * (4.6 * 3.6 - 3.8 * 2.8), 1e-12);
}

TEST(Cornice, FollowsCornersThatGoInwards) {
    const Swept ring = swept({l_shape()}, cornice());
    EXPECT_EQ(ring.count, 6U);
    EXPECT_EQ(ring.mitres, 12U);
    // Offset by d, a plan of area A and length L has A + L d + (5 - 1) d^2.
    EXPECT_NEAR(ring.volume, 0.3 * (16 * 0.4 + 4 * (0.09 - 0.01)), 1e-12);
}

TEST(Cornice, FollowsTheSlopeOfEitherFace) {
    const std::vector<Polyhedron> roof = {examples::hip_roof(1, {0, 0, 0}, {6, 0, 4})};
    const Swept eaves = swept(roof, {{kSlope, kDown}, Turn::kConvex, kBand});
    EXPECT_EQ(eaves.count, 4U);
    EXPECT_EQ(eaves.mitres, 8U);
    EXPECT_NEAR(eaves.box.min().y(), -0.3, 1e-12);
    // At p = 0.1 of a slope of 45 degrees and q = 0.3 below its foot.
    EXPECT_NEAR(eaves.box.max().x(), 6 + 0.3 + 0.1 * std::sqrt(2), 1e-12);
    // The ridge and the hips: three of them meet at its ends.
    const Swept ridges = swept(roof, {{kSlope, kSlope}, Turn::kConvex, kBand});
    EXPECT_EQ(ridges.count, 5U);
    EXPECT_EQ(ridges.mitres, 0U);
}

TEST(Cornice, IsCappedWhereMoreThanTwoEdgesMeet) {
    const Swept all = swept({box(1, {0, 0, 0}, {4, 2, 3})}, {{kAny, kAny}, Turn::kConvex, kBand});
    EXPECT_EQ(all.count, 12U);
    EXPECT_EQ(all.mitres, 0U);
    EXPECT_NEAR(all.volume, 4 * (4 + 2 + 3) * 0.3 * 0.4, 1e-12);
}

TEST(Cornice, IsCappedWhereMitresWouldCross) {
    // 0.1 within from either side is beyond the middle of 0.15.
    const Swept thin = swept({box(1, {0, 0, 0}, {4, 2, 0.15})}, cornice());
    EXPECT_EQ(thin.count, 4U);
    EXPECT_EQ(thin.mitres, 0U);
    EXPECT_NEAR(thin.volume, 2 * (4 + 0.15) * 0.3 * 0.4, 1e-12);
}

TEST(Cornice, IsOnePerPieceWhereTheyTouch) {
    for (const double y : {0.0, 2.0}) {
        const Swept rings =
            swept({box(1, {0, 0, 0}, {2, 2, 2}), box(1, {2, y, 2}, {4, y + 2, 4})}, cornice());
        EXPECT_EQ(rings.count, 8U);
        EXPECT_EQ(rings.mitres, 16U);
        EXPECT_NEAR(rings.volume, 2 * 0.3 * (2.6 * 2.6 - 1.8 * 1.8), 1e-12);
    }
}

TEST(Cornice, IsLeftOutWhereItWouldComeFarOut) {
    // Two slopes at which a step of 1 metre is 11 metres long.
    const Polyhedron flat = examples::prism_along_z(1, {{0, 0}, {20, 0}, {10, 0.9}}, 0, 5);
    const EdgeDecoration steps = {
        {kSlope, kSlope}, Turn::kConvex, {{0, 0}, {1, 0}, {1, -1}, {0, -1}}};
    EXPECT_EQ(swept({flat}, steps).count, 0U);
    const EdgeDecoration even = {{kSlope, kSlope}, Turn::kConvex, {{0, 0}, {1, 0.9}, {0.9, 1}}};
    EXPECT_EQ(swept({flat}, even).count, 1U);
}

TEST(EdgeDecorations, AreOfConcaveEdgesWhereAskedFor) {
    const EdgeDecoration cove = {{kSide, kSide}, Turn::kConcave, {{0, 0}, {0.5, 0}, {0, 0.5}}};
    const Swept one = swept({l_shape()}, cove);
    EXPECT_EQ(one.count, 1U);
    EXPECT_NEAR(one.volume, 2 * 0.5 * 0.5 / 2, 1e-12);
    // At (2, 2) of the plan, out of both walls there; z is against the plan's second axis.
    EXPECT_TRUE(one.box.min().isApprox(Point(2, 0, -2.5), 1e-12));
    EXPECT_TRUE(one.box.max().isApprox(Point(2.5, 2, -2), 1e-12));
    EdgeDecoration convex = cove;
    convex.turn = Turn::kConvex;
    EXPECT_EQ(swept({l_shape()}, convex).count, 5U);
}

TEST(EdgeDecorations, AreOfFacesOfANormal) {
    EdgeDecoration south = cornice();
    south.faces[1] = {FaceKind::kNormal, {0, 0, 3}};
    const Swept one = swept({box(1, {0, 0, 0}, {4, 2, 3})}, south);
    EXPECT_EQ(one.count, 1U);
    EXPECT_EQ(one.box.min().x(), 0);
    EXPECT_NEAR(one.box.max().z(), 3.3, 1e-12);
}

TEST(EdgeDecorations, EndWhereAnotherObjectBegins) {
    // On the eastern half of the roof.
    const Swept half =
        swept({box(1, {0, 0, 0}, {4, 2, 4}), box(2, {2, 2, 0}, {4, 3, 4})}, cornice());
    EXPECT_EQ(half.count, 3U);
    EXPECT_EQ(half.mitres, 4U);
    EXPECT_EQ(half.box.max().x(), 2);
    EXPECT_NEAR(half.volume, 0.3 * (2.3 * 4.6 - 1.9 * 3.8), 1e-12);
    // Beside the middle of a wall, as high as that: of its edge the two ends are left.
    const Swept ends =
        swept({box(1, {0, 0, 0}, {4, 2, 4}), box(2, {4, 1, 1}, {6, 2, 2})}, cornice());
    EXPECT_EQ(ends.count, 5U);
    EXPECT_EQ(ends.mitres, 8U);
    EXPECT_NEAR(ends.volume, 0.3 * (4.6 * 4.6 - 3.8 * 3.8) - 0.3 * 0.4, 1e-12);
    // In the middle of the roof, where it touches no edge.
    EXPECT_EQ(
        swept({box(1, {0, 0, 0}, {4, 2, 4}), box(2, {1, 2, 1}, {2, 3, 2})}, cornice()).mitres, 8U
    );
    // Under a floor, and over one.
    EXPECT_EQ(
        swept(
            {box(1, {0, 0, 0}, {4, 2, 4}), box(2, {-9, -1, -9}, {9, 0, 9})},
            {{kDown, kSide}, Turn::kConvex, kBand}
        )
            .count,
        0U
    );
    EXPECT_EQ(
        swept({box(1, {0, 0, 0}, {4, 2, 4}), box(2, {-9, 2, -9}, {9, 3, 9})}, cornice()).count, 0U
    );
}

TEST(EdgeDecorations, AreNoneOfWhatShapesReplace) {
    Example example = example_of({box(1, {0, 0, 0}, {4, 2, 3})});
    example.objects[0].decorations = {
        cornice(), CornerDecoration{{kUp, kSide, kSide}, Turn::kConvex, unit_cube()}};
    const Model model(example.polyhedra);
    PlacedShapes shapes;
    shapes.is_replaced.assign(model.surface.polygons.size(), 1);
    const PlacedDecorations placed =
        place_decorations(example, model.normals, model.surface, shapes);
    EXPECT_TRUE(placed.sweeps.empty());
    EXPECT_TRUE(placed.meshes.empty());
}

TEST(CornerDecorations, AreAtCornersOfTheirFacesAndTurn) {
    const auto count = [](const Polyhedron& solid, const std::array<FaceChoice, 3>& faces, Turn turn
                       ) {
        Example example = example_of({solid});
        example.objects[0].decorations = {CornerDecoration{faces, turn, unit_cube()}};
        return meshes(example).size();
    };
    const Polyhedron hall = box(1, {0, 0, 0}, {4, 2, 3});
    EXPECT_EQ(count(hall, {kUp, kSide, kSide}, Turn::kConvex), 4U);
    EXPECT_EQ(count(hall, {kAny, kAny, kAny}, Turn::kConvex), 8U);
    EXPECT_EQ(count(hall, {kSide, kSide, kSide}, Turn::kAny), 0U);
    EXPECT_EQ(count(l_shape(), {kSide, kUp, kSide}, Turn::kConvex), 5U);
    EXPECT_EQ(count(l_shape(), {kSide, kUp, kSide}, Turn::kConcave), 1U);
    EXPECT_EQ(count(l_shape(), {kSide, kUp, kSide}, Turn::kAny), 6U);
    const Polyhedron spire = examples::pyramid(1, {{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 0, {1, 3, -1});
    EXPECT_EQ(count(spire, {kSlope, kSlope, kSlope}, Turn::kConvex), 1U);
    EXPECT_EQ(count(spire, {kSlope, kSlope, kDown}, Turn::kConvex), 4U);
}

TEST(CornerDecorations, LookOutwardsWhereTurned) {
    Example example = example_of({box(1, {0, 0, 0}, {4, 2, 3})});
    CornerDecoration decoration = {{kUp, kSide, kSide}, Turn::kConvex, unit_cube(), true};
    example.objects[0].decorations = {decoration};
    const Model model(example.polyhedra);
    const PlacedDecorations turned = model.placed(example);
    ASSERT_EQ(turned.meshes.size(), 4U);
    for (const PlacedMesh& mesh : turned.meshes) {
        const Point middle(2, 2, 1.5);
        const Point out = (mesh.at - middle).cwiseSign() / std::sqrt(2.0);
        EXPECT_TRUE(mesh.outwards.isApprox(out, 1e-12));
        double farthest = 0;
        double volume = 0;
        const std::vector<ShapeCorner> corners = triangles_of(mesh);
        ASSERT_EQ(corners.size(), 36U);
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const Point across = (corners[i + 1].place - corners[i].place)
                                     .cross(corners[i + 2].place - corners[i].place);
            volume += across.dot(corners[i].place) / 6;
            EXPECT_GT(across.dot(corners[i].normal), 0);
            farthest = std::max(farthest, (corners[i].place - mesh.at).dot(out));
        }
        EXPECT_NEAR(volume, 1, 1e-12);
        EXPECT_NEAR(farthest, 1, 1e-12);
    }
    decoration.is_turned = false;
    example.objects[0].decorations = {decoration};
    for (const PlacedMesh& mesh : model.placed(example).meshes) {
        EXPECT_EQ(mesh.outwards, Point::UnitX());
    }
}

TEST(CornerDecorations, AreNoneAgainstOtherObjects) {
    const auto count = [](const Polyhedron& other) {
        Example example = example_of({box(1, {0, 0, 0}, {4, 2, 4}), other});
        example.objects[0].decorations = {
            CornerDecoration{{kUp, kSide, kSide}, Turn::kConvex, unit_cube()}};
        return meshes(example).size();
    };
    EXPECT_EQ(count(box(2, {0, 2, 0}, {1, 3, 1})), 3U);  // on a corner
    EXPECT_EQ(count(box(2, {2, 2, 0}, {4, 3, 4})), 2U);  // on half of the roof
    EXPECT_EQ(count(box(2, {1, 2, 1}, {2, 3, 2})), 4U);  // in its middle
    EXPECT_EQ(count(box(2, {4, 0, 0}, {6, 1, 4})), 4U);  // beside the foot of a wall
    EXPECT_EQ(count(box(2, {4, 0, 0}, {6, 3, 4})), 2U);  // beside a wall
}

TEST(Decorations, AreNoneWhereTheyWouldBeTooManyTriangles) {
    std::vector<ProfilePoint> round;
    for (std::size_t i = 0; i < kProfilePointsMax; ++i) {
        const double angle = 2 * std::acos(-1.0) * static_cast<double>(i) / kProfilePointsMax;
        round.push_back({0.1 * std::cos(angle), 0.1 * std::sin(angle)});
    }
    EXPECT_TRUE(is_simple(round));
    std::vector<Polyhedron> boxes;
    for (int x = 0; x < 1954; ++x) {  // of 4 * 128 triangles each
        boxes.push_back(box(1, {3.0 * x, 0, 0}, {3.0 * x + 1, 1, 1}));
        if (x < 1952) {
            continue;
        }
        Example example = example_of({});
        example.objects[0].decorations = {EdgeDecoration{{kUp, kSide}, Turn::kConvex, round}};
        const PlacedDecorations placed = Model(boxes).placed(example);
        EXPECT_EQ(placed.are_too_many, x == 1953);
        EXPECT_EQ(placed.sweeps.size(), placed.are_too_many ? 0U : 4 * boxes.size());
    }
}

TEST(Profiles, AreSimple) {
    EXPECT_TRUE(is_simple(kBand));
    EXPECT_TRUE(is_simple({{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_TRUE(is_simple({{0, 0}, {1, 0}, {2, 0}, {0, 1}}));
    EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {2, 0}}));
    EXPECT_FALSE(is_simple({{0, 0}, {1, 1}, {1, 0}, {0, 1}}));                   // crosses
    EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}));           // touches
    EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {2, 1}, {2, 0}, {0, 1}}));           // goes back
    EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {1, 0}, {0, 1}}));                   // twice a point
    EXPECT_FALSE(is_simple({{0, 0}, {3, 0}, {3, 2}, {1, 2}, {1, -1}, {0, 2}}));  // crosses
}

// Skyscrapers, with a cornice and balls of a material of their own on what stands highest.
std::shared_ptr<const ExampleReading> decorated_skyscrapers() {
    Example example = examples::make_skyscrapers();
    example.materials.push_back({"gold", {}});
    example.objects.push_back({"gold", static_cast<std::uint32_t>(example.materials.size() - 1)});
    const auto gold = static_cast<std::uint8_t>(example.objects.size());
    for (const char* name : {"cap", "crown", "slab", "stone"}) {
        EdgeDecoration moulding = cornice();
        moulding.look = gold;
        example.objects[find_object(example, name) - 1U].decorations = {
            moulding, CornerDecoration{{kUp, kSide, kSide}, Turn::kAny, unit_cube(), true, gold}};
    }
    return ExampleReading::make(example).value();
}

std::size_t gold_triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.kit->meshes) {
        for (const Primitive& primitive : mesh.primitives) {
            const bool is_gold = scene.kit->materials[primitive.material].name == "gold";
            count += is_gold ? primitive.indices.size() / 3 : 0;
        }
    }
    return count;
}

TEST(Decorations, OfPatchesAreThoseOfTheModel) {
    const auto reading = decorated_skyscrapers();
    Parameters parameters;
    parameters.size = {24, 12, 24};
    parameters = fill_defaults(parameters, reading->example());
    const Problem problem = make_problem(reading, parameters).value();
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        RecordingObserver observer;
        const Synthesis made = synthesise(problem, parameters, seed, observer, {}).value();
        const Surface surface = make_surface(problem, made.labels);
        const PlacedDecorations placed = place_decorations(
            reading->example(),
            reading->topes().normals(),
            surface,
            place_shapes(reading->example(), surface)
        );
        const Swept all = check_closed(placed.sweeps);
        EXPECT_GT(all.mitres, 10U);
        EXPECT_GT(placed.meshes.size(), 10U);
        const std::size_t whole = gold_triangles(make_scene(*reading, surface));
        EXPECT_EQ(whole, all.triangles + 12 * placed.meshes.size());
        std::size_t sum = 0;
        for (const double x : {0.0, 9.0, 18.0}) {
            for (const double y : {0.0, 4.0, 8.0}) {
                for (const double z : {0.0, 12.0}) {
                    const Bounds part = {{x, y, z}, {x + 9, y + 4, z + 12}};
                    sum += gold_triangles(make_scene(*reading, surface, part));
                }
            }
        }
        EXPECT_EQ(sum, whole);
    }
}

}  // namespace
}  // namespace modelsynth::continuous
