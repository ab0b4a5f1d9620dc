// Models of solids, checked by what one sees of them.

#include "solver/continuous/decoration/decoration_meshes.h"
#include "solver/continuous/decoration/placed_decorations.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/case_count.h"
#include "tests/support/examples.h"
#include "tests/support/random_solids.h"
#include "tests/support/surface_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using testing::ModelFaults;
using testing::RecordingObserver;
using testing::solid_case_count;
using testing::SolidsKind;
using testing::SurfaceChecker;

using Reading = std::shared_ptr<const ExampleReading>;

Eigen::AlignedBox3d box_of(const Problem& problem) {
    const Bounds& box = problem.arrangement.frame().box;
    return {box.min, box.max};
}

Parameters parameters_of(const Example& example, const std::array<double, 3>& size) {
    Parameters parameters;
    parameters.size = size;
    if (!example.constraints.empty()) {
        parameters.constraints.emplace();  // masks leave no place in a small model
    }
    return fill_defaults(parameters, example);
}

struct Model {
    Eigen::AlignedBox3d box;
    Surface surface;
};

Model make_model(const Reading& reading, const std::array<double, 3>& size, std::uint64_t seed) {
    const Parameters parameters = parameters_of(reading->example(), size);
    const Problem problem = make_problem(reading, parameters).value();
    RecordingObserver observer;
    const Synthesis made = synthesise(problem, parameters, seed, observer, {}).value();
    return {box_of(problem), make_surface(problem, made.labels)};
}

std::string text(const ModelFaults& faults) {
    std::string all;
    for (const std::string& fault : faults) {
        all += fault + "\n";
    }
    return all;
}

void expect_right(const SurfaceChecker& checker, const Reading& reading, const Model& model) {
    EXPECT_EQ(text(checker.find_faults(model.surface, model.box)), "");
    EXPECT_EQ(text(checker.find_faults(make_scene(*reading, model.surface), model.surface)), "");
}

// The same example, whose models are no more than their polygons and shapes.
Reading without_decorations(const Reading& reading) {
    Example example = reading->example();
    for (ObjectType& object : example.objects) {
        object.decorations.clear();
    }
    return ExampleReading::make(std::move(example)).value();
}

class SolidsBuiltIn : public ::testing::TestWithParam<std::size_t> {
  protected:
    [[nodiscard]] static Reading reading() { return examples::built_in_solids()[GetParam()]; }
};

TEST_P(SolidsBuiltIn, MakeModelsInWhichAllStandsAsInTheExample) {
    const Reading plain = without_decorations(reading());
    const SurfaceChecker checker(plain->example());
    const SurfaceChecker checker_of_decorations(reading()->example());
    std::size_t polygons = 0;
    for (std::uint64_t seed = 1; seed <= solid_case_count(20); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto extent = [&](std::uint64_t step) {
            return 8 + static_cast<double>(seed * step % 13) / 2;
        };
        const Model model = make_model(reading(), {extent(5), extent(3), extent(7)}, seed);
        expect_right(checker, plain, model);
        const Scene decorated = make_scene(*reading(), model.surface);
        EXPECT_EQ(text(checker_of_decorations.find_faults(decorated, model.surface)), "");
        polygons += model.surface.polygons.size();
    }
    EXPECT_GT(polygons, solid_case_count(20) * 10U);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    SolidsBuiltIn,
    ::testing::Range<std::size_t>(0, examples::built_in_solids().size()),
    [](const auto& tested) { return examples::built_in_solids()[tested.param]->example().name; }
);

std::string name_of(const ::testing::TestParamInfo<SolidsKind>& tested) {
    constexpr std::array<const char*, testing::kSolidsKindCount> kNames = {
        "Boxes", "Wedges", "Tetrahedra", "Convex", "Slivers"};
    return kNames.at(static_cast<std::size_t>(tested.param));
}

// Whatever meets at an edge: sweeps are closed, and none of their faces is inside out.
std::size_t expect_closed_sweeps(const Reading& reading, const Surface& surface) {
    Example example = reading->example();
    for (ObjectType& object : example.objects) {
        for (const Turn turn : {Turn::kConvex, Turn::kConcave}) {
            for (const FaceKind kind : {FaceKind::kAny, FaceKind::kSlope, FaceKind::kSide}) {
                object.decorations.push_back(EdgeDecoration{
                    {FaceChoice{FaceKind::kAny}, FaceChoice{kind}},
                    turn,
                    {{-0.1, -0.2}, {0.15, -0.1}, {0.1, 0.2}}});
            }
        }
    }
    const PlacedDecorations placed = place_decorations(
        example, reading->topes().normals(), surface, place_shapes(example, surface)
    );
    EXPECT_FALSE(placed.are_too_many);
    std::map<std::array<double, 6>, int> balance;
    std::size_t mitres = 0;
    for (const Sweep& sweep : placed.sweeps) {
        const SweptMesh mesh = mesh_of(sweep);
        mitres += sweep.ends[0].is_mitred ? 1U : 0U;
        const Point along = sweep.ends[1].at - sweep.ends[0].at;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const Face& face = mesh.faces[f];
            for (std::size_t i = 0; i < face.size(); ++i) {
                const Point& a = mesh.corners[face[i]];
                const Point& b = mesh.corners[face[(i + 1) % face.size()]];
                ++balance[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
                --balance[{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()}];
            }
            // A side runs forth along its edge and back.
            if (f < 3) {
                const Point forth = mesh.corners[face[2]] - mesh.corners[face[1]];
                EXPECT_GT(forth.dot(along), 0);
                EXPECT_LT(forth.cross(along).norm(), 1e-6 * along.squaredNorm());
            }
        }
    }
    for (const auto& [edge, sum] : balance) {
        EXPECT_EQ(sum, 0);
    }
    return mitres;
}

class RandomSolids : public ::testing::TestWithParam<SolidsKind> {};

TEST_P(RandomSolids, AreRefusedOrMakeModelsInWhichAllStandsAsInThem) {
    std::size_t models = 0;
    std::size_t mitres = 0;
    for (std::uint32_t seed = 0; seed < solid_case_count(40); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Example example = make_random_solids(GetParam(), seed);
        const auto reading = ExampleReading::make(example);
        if (!reading) {
            EXPECT_NE(reading.error().code, ErrorCode::kInternal);
            EXPECT_NE(reading.error().message, "");
            continue;
        }
        // Where many families meet, models have more vertices than a test has time for.
        const double extent = (*reading)->topes().family_count() > 7 ? 3 : 6;
        const Parameters parameters = parameters_of(example, {extent, extent - 1, extent});
        const auto problem = make_problem(*reading, parameters);
        if (!problem) {
            EXPECT_NE(problem.error().code, ErrorCode::kInternal);
            continue;
        }
        const SurfaceChecker checker(example);
        EXPECT_EQ(checker.cells().count(), checker.cells().expected_count());
        for (const std::uint64_t run : {1U, 2U}) {
            RecordingObserver observer;
            const auto made = synthesise(*problem, parameters, run, observer, {});
            ASSERT_TRUE(made) << made.error().message;
            const Surface surface = make_surface(*problem, made->labels);
            expect_right(checker, *reading, {box_of(*problem), surface});
            mitres += expect_closed_sweeps(*reading, surface);
            ++models;
        }
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GT(models, solid_case_count(20));
        EXPECT_GT(mitres, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    RandomSolids,
    ::testing::Values(
        SolidsKind::kBoxes,
        SolidsKind::kWedges,
        SolidsKind::kTetrahedra,
        SolidsKind::kConvex,
        SolidsKind::kSlivers
    ),
    name_of
);

// A block on a larger one: the border of the upper one's foot is a hole in the lower one's top.
Example make_tiers() {
    Example example = examples::make_skyscrapers();
    example.polyhedra = {
        examples::box(2, {0, 0, 0}, {3, 1, 3}), examples::box(2, {1, 1, 1}, {2, 2, 2})};
    return example;
}

// The checker itself: faults that it must find.
class SurfaceFaults : public ::testing::Test {
  protected:
    [[nodiscard]] ModelFaults faults(const Surface& surface) const {
        return checker_.find_faults(surface, model_.box);
    }

    // Calls try_with(surface, polygon) with a fresh copy for some polygons.
    template <class TryWith>
    void for_some_polygons(TryWith try_with) const {
        for (std::size_t p = 0; p < model_.surface.polygons.size(); p += 7) {
            SCOPED_TRACE("polygon " + std::to_string(p));
            Surface copy = model_.surface;
            try_with(copy, copy.polygons[p]);
            EXPECT_FALSE(faults(copy).empty());
        }
    }

    Reading houses_ = ExampleReading::make(examples::make_houses()).value();
    SurfaceChecker checker_ = SurfaceChecker(houses_->example());
    Model model_ = make_model(houses_, {12, 8, 12}, 3);
};

TEST_F(SurfaceFaults, AreNoneInTheModelItself) {
    expect_right(checker_, houses_, model_);
    EXPECT_GT(model_.surface.polygons.size(), 50U);
}

TEST_F(SurfaceFaults, AreCornersThatWereMoved) {
    for_some_polygons([](Surface& surface, const SurfacePolygon& polygon) {
        surface.points[polygon.loops.front().front()] += Point(0.1, 0, 0);
    });
    for_some_polygons([](Surface& surface, const SurfacePolygon& polygon) {
        surface.points[polygon.loops.front().back()] += Point(0, 1e-5, 1e-5);
    });
}

TEST_F(SurfaceFaults, ArePolygonsThatAreMissing) {
    for_some_polygons([](Surface& surface, SurfacePolygon& polygon) {
        std::swap(polygon, surface.polygons.back());
        surface.polygons.pop_back();
    });
}

TEST_F(SurfaceFaults, ArePolygonsThatAreTwice) {
    for_some_polygons([](Surface& surface, const SurfacePolygon& polygon) {
        surface.polygons.push_back(SurfacePolygon(polygon));
    });
}

TEST_F(SurfaceFaults, ArePolygonsInsideOut) {
    for_some_polygons([](const Surface& /*surface*/, SurfacePolygon& polygon) {
        for (std::vector<std::uint32_t>& loop : polygon.loops) {
            std::reverse(loop.begin(), loop.end());
        }
    });
}

TEST_F(SurfaceFaults, ArePolygonsOfAnotherObject) {
    for_some_polygons([](const Surface& /*surface*/, SurfacePolygon& polygon) {
        polygon.object = polygon.object == 3 ? ObjectId{2} : ObjectId{3};
    });
}

TEST_F(SurfaceFaults, AreHolesThatAreFilled) {
    const Reading reading = ExampleReading::make(make_tiers()).value();
    const SurfaceChecker checker(reading->example());
    std::size_t holes = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Model model = make_model(reading, {9, 6, 9}, seed);
        expect_right(checker, reading, model);
        for (std::size_t p = 0; p < model.surface.polygons.size(); ++p) {
            if (model.surface.polygons[p].loops.size() > 1) {
                ++holes;
                Surface copy = model.surface;
                copy.polygons[p].loops.pop_back();
                EXPECT_FALSE(checker.find_faults(copy, model.box).empty());
            }
        }
    }
    EXPECT_GT(holes, 0U);
}

// Closed and flat, but where nothing of the example stands so.
TEST_F(SurfaceFaults, AreHousesThatFloat) {
    for (const double height : {0.5, 1.0, 1e-3}) {
        Surface copy = model_.surface;
        std::map<std::uint32_t, std::uint32_t> lifted;
        for (SurfacePolygon& polygon : copy.polygons) {
            if (polygon.object == 1) {
                continue;
            }
            for (std::vector<std::uint32_t>& loop : polygon.loops) {
                for (std::uint32_t& point : loop) {
                    const auto next = static_cast<std::uint32_t>(copy.points.size());
                    const auto [at, is_new] = lifted.try_emplace(point, next);
                    if (is_new) {
                        copy.points.push_back(copy.points[point] + Point(0, height, 0));
                    }
                    point = at->second;
                }
            }
        }
        EXPECT_NE(text(faults(copy)).find("what stands nowhere in the example"), std::string::npos);
    }
}

TEST_F(SurfaceFaults, AreObjectsThatChangePlaces) {
    Surface copy = model_.surface;
    for (SurfacePolygon& polygon : copy.polygons) {
        if (polygon.object == 2 || polygon.object == 3) {
            polygon.object = polygon.object == 3 ? ObjectId{2} : ObjectId{3};
        }
    }
    EXPECT_NE(text(faults(copy)).find("what stands nowhere in the example"), std::string::npos);
}

Example make_tower_and_wing() {
    Example example;
    example.name = "wing";
    example.materials = {{"ground", {}}, {"tower", {}}};
    example.objects = {{"ground", 0}, {"tower", 1}};
    example.ground = 1;
    example.polyhedra = {
        examples::box(2, {0, 0, 0}, {4, 3, 2}), examples::box(2, {0, 0, 2}, {2, 2, 4})};
    return example;
}

TEST_F(SurfaceFaults, AreModelsOfOtherExamples) {
    const SurfaceChecker skyscrapers(examples::make_skyscrapers());
    EXPECT_FALSE(skyscrapers.find_faults(model_.surface, model_.box).empty());
    const Reading towers = ExampleReading::make(make_tower_and_wing()).value();
    const Model city = make_model(towers, {12, 8, 12}, 1);
    EXPECT_FALSE(checker_.find_faults(city.surface, city.box).empty());
    // The same normals and objects, but no corner where a tower meets its wing.
    Example plain = make_tower_and_wing();
    plain.polyhedra.pop_back();
    EXPECT_NE(
        text(SurfaceChecker(plain).find_faults(city.surface, city.box))
            .find("what stands nowhere in the example"),
        std::string::npos
    );
}

TEST_F(SurfaceFaults, AreTrianglesThatLeaveGaps) {
    const Scene scene = make_scene(*houses_, model_.surface);
    const auto broken = [&](const auto& change) {
        auto kit = std::make_shared<Kit>(*scene.kit);
        change(kit->meshes.front().primitives.front());
        Scene copy = scene;
        copy.kit = std::move(kit);
        return !checker_.find_faults(copy, model_.surface).empty();
    };
    EXPECT_FALSE(broken([](Primitive& /*part*/) {}));
    EXPECT_TRUE(broken([](Primitive& part) { part.indices.resize(part.indices.size() - 3); }));
    EXPECT_TRUE(broken([](Primitive& part) { std::swap(part.indices[0], part.indices[1]); }));
    EXPECT_TRUE(broken([](Primitive& part) { part.positions[part.indices[0]].x += 0.01F; }));
    EXPECT_TRUE(broken([](Primitive& part) { part.normals[part.indices[0]] = {0.6F, 0.8F, 0}; }));
}

}  // namespace
}  // namespace modelsynth::continuous
