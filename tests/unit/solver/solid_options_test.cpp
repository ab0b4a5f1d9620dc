// What requests can ask of models of solids beside constraints: free sides, turned variants, jitter
// and perturbation.

#include "solver/continuous/faults.h"
#include "solver/continuous/planes/model_planes.h"
#include "solver/continuous/planes/spacing.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/surface/loops.h"
#include "solver/continuous/surface/rim.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/continuous/warnings.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using testing::RecordingObserver;

using Reading = std::shared_ptr<const ExampleReading>;

Surface make(const Reading& reading, const Parameters& parameters, std::uint64_t seed) {
    const Problem problem = make_problem(reading, parameters).value();
    RecordingObserver observer;
    return make_surface(problem, synthesise(problem, parameters, seed, observer, {})->labels);
}

Example on_grass(std::vector<Polyhedron> solids) {
    Example example;
    example.name = "test";
    example.materials = {{"grass", {}}, {"wall", {}}};
    example.objects = {{"grass", 0}, {"wall", 1}};
    example.ground = 1;
    example.polyhedra = std::move(solids);
    example.density = 0.8;
    return example;
}

// A wall that is one metre thick and as long as one likes, without ends: it leaves the bounds. And
// a block, so that there are planes across it.
Reading read_endless_wall() {
    Example example = on_grass({box(2, {-5, 0, 1}, {15, 2, 2}), box(3, {3, 0, 3}, {5, 1, 4})});
    example.materials.push_back({"block", {}});
    example.objects.push_back({"block", 2});
    example.bounds = Bounds{Point(0, -1, 0), Point(10, 4, 5)};
    auto reading = ExampleReading::make(std::move(example));
    EXPECT_TRUE(reading) << reading.error().message;
    return reading.value();
}

Parameters sized(const Reading& reading, const std::array<double, 3>& size) {
    Parameters parameters;
    parameters.size = size;
    return fill_defaults(parameters, reading->example());
}

// Area of an object's polygons in a plane of an axis.
double area_at(const Surface& surface, ObjectId object, int axis, double place) {
    double area = 0;
    for (const SurfacePolygon& polygon : surface.polygons) {
        const auto& loop = polygon.loops.front();
        const bool is_there = std::all_of(loop.begin(), loop.end(), [&](std::uint32_t point) {
            return std::abs(surface.points[point][axis] - place) < 2e-3;  // a free side is nearer
        });
        if (polygon.object == object && is_there) {
            for (const auto& one : polygon.loops) {
                area += area_vector(surface.points, one)
                            .dot(area_vector(surface.points, loop).normalized());
            }
        }
    }
    return area;
}

TEST(FreeSides, LetGoOnWhatHasNoEnd) {
    const Reading reading = read_endless_wall();
    Parameters parameters = sized(reading, {8, 4, 8});
    EXPECT_EQ(area_at(make(reading, parameters, 1), 2, 0, 0), 0);
    parameters.boundary[0] = parameters.boundary[1] = SideKind::kFree;
    parameters.weights = {{"wall", 30}, {"block", 0.1}};
    double largest = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Surface surface = make(reading, parameters, seed);
        const double west = area_at(surface, 2, 0, 0);
        EXPECT_NEAR(west, area_at(surface, 2, 0, 8), 1e-9);  // no wall ends within
        EXPECT_EQ(area_at(surface, 2, 2, 0), 0);             // the others are closed
        largest = std::max(largest, west);
    }
    EXPECT_GE(largest, 1);
}

TEST(FreeSides, OfWhichOneIsFreeChangeNothingOfWhatMustEnd) {
    const Reading reading = read_endless_wall();
    Parameters parameters = sized(reading, {8, 4, 8});
    parameters.boundary[0] = SideKind::kFree;  // the wall would have to end in the east
    const Surface surface = make(reading, parameters, 3);
    EXPECT_EQ(area_at(surface, 2, 0, 0), 0);
}

// Borders as labels should never leave them; a request must not be able to end the program.
TEST(Loops, AreNoneWhereABorderEndsAndNoneGoesOn) {
    const Bounds box = {Point(0, 0, 0), Point(4, 4, 4)};
    const Rim rim = rim_of(box, Point::UnitY(), 2);
    PointTable points(box);
    const std::uint32_t inner = points.add({2, 2, 2});
    const std::uint32_t west = points.on_box({0, 2, 2});
    const std::uint32_t east = points.on_box({4, 2, 2});
    const auto find = [&](const std::vector<PlaneEdge>& edges) {
        return find_loops(points, edges, Point::UnitY(), rim, 0, false);
    };
    EXPECT_FALSE(find({{west, inner}}));                 // ends within
    EXPECT_FALSE(find({{inner, west}}));                 // begins within
    EXPECT_FALSE(find({{west, inner}, {east, inner}}));  // meet head on
    EXPECT_FALSE(find({{inner, west}, {inner, east}}));  // meet the rim from one side only
    const auto through = find({{west, inner, true}, {inner, east, false}});
    ASSERT_TRUE(through);
    ASSERT_EQ(through->polygons.size(), 1U);
    EXPECT_EQ(through->polygons[0][0].size(), 4U);
    EXPECT_EQ(through->pieces.size(), 3U);
}

// The roof's slopes look east and west only.
Reading read_gabled_house() {
    return ExampleReading::make(
               on_grass({examples::prism_along_z(2, {{0, 0}, {4, 0}, {4, 2}, {2, 4}, {0, 2}}, 0, 5)}
               )
    )
        .value();
}

TEST(Loops, ThatAreMissingLeaveAModelThatCanBeDrawn) {
    const Reading houses = examples::find_solids("houses");
    const Parameters parameters = sized(houses, {12, 8, 12});
    Surface surface = make(houses, parameters, 2);
    surface.polygons.erase(surface.polygons.begin(), surface.polygons.begin() + 20);
    surface.is_closed = false;
    EXPECT_FALSE(make_scene(*houses, surface).names.empty());
}

TEST(Variants, ReadTheExampleInAllTheWaysAskedFor) {
    const Reading reading = read_gabled_house();
    Parameters parameters = sized(reading, {16, 6, 16});
    EXPECT_EQ(ExampleReading::read_for(reading, parameters).value(), reading);
    const std::size_t families = reading->topes().family_count();
    parameters.variants.mirror_x = true;  // it is its own image
    const Reading mirrored = ExampleReading::read_for(reading, parameters).value();
    EXPECT_EQ(mirrored->figures().count(), reading->figures().count());
    parameters.variants.turns = 4;
    const Reading turned = ExampleReading::read_for(reading, parameters).value();
    EXPECT_EQ(turned->topes().family_count(), families + 2);
    EXPECT_EQ(ExampleReading::read_for(reading, parameters).value(), turned);
    EXPECT_EQ(ExampleReading::read_for(turned, parameters).value(), turned);
    EXPECT_EQ(turned->example().objects.size(), reading->example().objects.size());
}

TEST(Variants, StandInOneModel) {
    const Reading reading = read_gabled_house();
    Parameters parameters = sized(reading, {24, 6, 24});
    parameters.variants.turns = 4;
    const Reading turned = ExampleReading::read_for(reading, parameters).value();
    std::set<int> slopes;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Surface surface = make(turned, parameters, seed);
        for (const SurfacePolygon& polygon : surface.polygons) {
            const Point normal = area_vector(surface.points, polygon.loops.front()).normalized();
            if (normal.y() > 0.1 && normal.y() < 0.9) {
                slopes.insert(std::abs(normal.x()) > 0.1 ? 0 : 2);
            }
        }
    }
    EXPECT_EQ(slopes, (std::set{0, 2}));
}

TEST(Variants, OfWhatHasADimensionAreObjectsOfTheirOwn) {
    Example example = on_grass({box(2, {0, 0, 0}, {6, 2, 1})});
    example.dimensions = {{2, Point::UnitZ()}};
    const Reading reading = ExampleReading::make(std::move(example)).value();
    Parameters parameters = sized(reading, {20, 4, 20});
    parameters.variants.turns = 4;
    const Reading turned = ExampleReading::read_for(reading, parameters).value();
    ASSERT_EQ(turned->example().objects.size(), 5U);
    const ObjectId quarter = find_object(turned->example(), "wall turned 90");
    ASSERT_NE(quarter, kEmpty);
    EXPECT_EQ(turned->example().objects[quarter - 1U].variant_of, 2);
    std::set<ObjectId> seen;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Surface surface = make(turned, parameters, seed);
        for (const SurfacePolygon& polygon : surface.polygons) {
            if (polygon.object == 1 || polygon.family == kNoFamily) {
                continue;
            }
            seen.insert(polygon.object);
            // Its ends are one metre wide, across z as it stands and across x when it is turned.
            const int thin = polygon.object == quarter || polygon.object == quarter + 2 ? 0 : 2;
            double low = 1e9;
            double high = -1e9;
            for (const std::uint32_t point : polygon.loops.front()) {
                low = std::min(low, surface.points[point][thin]);
                high = std::max(high, surface.points[point][thin]);
            }
            EXPECT_TRUE(high - low < 1e-9 || std::abs(high - low - 1) < 1e-9) << high - low;
        }
    }
    EXPECT_GT(seen.size(), 2U);
    // Named together.
    parameters.weights = {{"wall", 0}};
    for (const SurfacePolygon& polygon : make(turned, parameters, 1).polygons) {
        EXPECT_EQ(polygon.object, 1);
    }
}

TEST(Variants, ThatAreTooManyObjectsAreRefused) {
    Example example;
    example.materials = {{}};
    for (int i = 0; i < 100; ++i) {
        example.objects.push_back({"object " + std::to_string(i), 0});
        example.dimensions.push_back({static_cast<ObjectId>(i + 1), Point::UnitX()});
    }
    example.polyhedra = {box(1, {0, 0, 0}, {1, 1, 1})};
    const Reading reading = ExampleReading::make(std::move(example)).value();
    Parameters parameters = sized(reading, {4, 4, 4});
    parameters.variants.turns = 2;
    EXPECT_TRUE(ExampleReading::read_for(reading, parameters));
    parameters.variants.turns = 4;
    const auto turned = ExampleReading::read_for(reading, parameters);
    ASSERT_FALSE(turned);
    EXPECT_EQ(turned.error().code, ErrorCode::kTooLarge);
}

TEST(Jitter, MovesPlanesButThoseThatMayNotBe) {
    const Reading reading = examples::find_solids("skyscrapers");
    Parameters parameters = sized(reading, {20, 10, 20});
    parameters.constraints.emplace();
    const ModelPlanes neat = make_planes(*reading, parameters);
    parameters.jitter = 0.4;
    const ModelPlanes moved = make_planes(*reading, parameters);
    const std::size_t horizontal = *reading->horizontal();
    std::size_t different = 0;
    for (std::size_t family = 0; family < neat.offsets.size(); ++family) {
        ASSERT_EQ(moved.offsets[family].size(), neat.offsets[family].size());
        for (std::size_t i = 0; i < neat.offsets[family].size(); ++i) {
            const double away = std::abs(moved.offsets[family][i] - neat.offsets[family][i]);
            EXPECT_LE(away, 0.2 * neat.spacings.of_family[family] + 1e-9);
            different += std::size_t{away > 1e-6};
            if (family == horizontal && neat.offsets[family][i] == 0) {
                EXPECT_EQ(away, 0);  // the ground
            }
        }
    }
    EXPECT_GT(different, 20U);
    // Houses have corners of four directions: their slopes and walls stay.
    const Reading houses = examples::find_solids("houses");
    Parameters of_houses = sized(houses, {20, 10, 20});
    const ModelPlanes stand = make_planes(*houses, of_houses);
    of_houses.jitter = 0.4;
    const FamilySet firm = dependent_families(houses->figures());
    ASSERT_NE(firm, 0U);
    const ModelPlanes still = make_planes(*houses, of_houses);
    for (std::size_t family = 0; family < stand.offsets.size(); ++family) {
        if ((firm >> family & 1) != 0) {
            EXPECT_EQ(still.offsets[family], stand.offsets[family]);
        }
    }
}

TEST(Perturbation, BreaksRowsAndKeepsTheGround) {
    const Reading reading = ExampleReading::make(on_grass({box(2, {0, 0, 0}, {2, 3, 2})})).value();
    Parameters parameters = sized(reading, {24, 5, 24});
    parameters.density = 0.4;
    const Surface neat = make(reading, parameters, 5);
    parameters.perturbation = 0.25;
    const Surface moved = make(reading, parameters, 5);
    ASSERT_EQ(moved.polygons.size(), neat.polygons.size());
    ASSERT_EQ(moved.points.size(), neat.points.size());
    std::set<long> rows_before;
    std::set<long> rows_after;
    for (std::size_t i = 0; i < neat.points.size(); ++i) {
        const Point shift = moved.points[i] - neat.points[i];
        EXPECT_LE(shift.cwiseAbs().maxCoeff(), 0.25 + 1e-9);
        if (neat.points[i].y() == 0) {
            EXPECT_EQ(moved.points[i].y(), 0);
        }
        rows_before.insert(std::lround(neat.points[i].x() * 1e4));
        rows_after.insert(std::lround(moved.points[i].x() * 1e4));
    }
    EXPECT_GT(rows_after.size(), 2 * rows_before.size());
}

TEST(Disorder, IsNoneWhereThereIsASymmetry) {
    const Reading reading = examples::find_solids("skyscrapers");
    Parameters parameters = sized(reading, {20, 10, 20});
    parameters.constraints = {{SymmetryRule{}}};
    EXPECT_TRUE(find_faults(*reading, parameters).empty());
    parameters.jitter = 0.1;
    parameters.perturbation = 0.1;
    std::set<std::string> pointers;
    for (const Fault& fault : find_faults(*reading, parameters)) {
        pointers.insert(fault.pointer);
    }
    EXPECT_TRUE(pointers.contains("/jitter"));
    EXPECT_TRUE(pointers.contains("/perturbation"));
}

// A tent over a pentagon, whose five slopes meet in one point, and a block beside it.
Reading read_pentagonal_tent() {
    examples::Outline plan;
    for (int i = 0; i < 5; ++i) {
        const double angle = i * 2 * std::numbers::pi / 5;
        plan.push_back({2 * std::cos(angle), 2 * std::sin(angle)});
    }
    Example example = on_grass(
        {examples::pyramid(2, plan, 0, {0, 2 * std::cos(std::numbers::pi / 5), 0}),
         box(3, {5, 0, 0}, {6, 1, 1})}
    );
    example.materials.push_back({"block", {}});
    example.objects.push_back({"block", 2, 0.1});
    return ExampleReading::make(std::move(example)).value();
}

// Points in which slopes of so many directions meet.
std::size_t points_of(const Surface& surface, std::size_t slopes) {
    std::vector<std::set<std::uint8_t>> families(surface.points.size());
    for (const SurfacePolygon& polygon : surface.polygons) {
        const Point normal = area_vector(surface.points, polygon.loops.front()).normalized();
        for (const std::uint32_t point : polygon.loops.front()) {
            if (normal.y() > 0.1 && normal.y() < 0.9) {
                families[point].insert(polygon.family);
            }
        }
    }
    return static_cast<std::size_t>(std::count_if(
        families.begin(), families.end(), [slopes](const auto& at) { return at.size() == slopes; }
    ));
}

TEST(Nudge, LetsFiveSlopesMeetWhereNoSpacingDoes) {
    const Reading reading = read_pentagonal_tent();
    Parameters parameters = sized(reading, {20, 6, 20});
    const Problem plain = make_problem(reading, parameters).value();
    EXPECT_FALSE(plain.spacings.conflicts.empty());
    EXPECT_EQ(points_of(make(reading, parameters, 1), 5), 0U);

    parameters.nudge = 5;
    const Reading nudged = ExampleReading::read_for(reading, parameters).value();
    ASSERT_NE(nudged->nudged(), nullptr);
    EXPECT_GT(nudged->nudged()->largest_degrees, 0.1);
    EXPECT_LE(nudged->nudged()->largest_degrees, 5);
    EXPECT_EQ(nudged->figures().count(), reading->figures().count());
    const Problem problem = make_problem(nudged, parameters).value();
    EXPECT_TRUE(problem.spacings.conflicts.empty());
    EXPECT_TRUE(problem.homeless.empty());
    const std::vector<std::string> warnings = warnings_of(problem);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings.front().find("degrees"), std::string::npos) << warnings.front();
    std::size_t tents = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        tents += points_of(make(nudged, parameters, seed), 5);
    }
    EXPECT_GT(tents, 4U);
    // Each normal as it was is still a name of its faces.
    for (const Point& normal : reading->topes().normals()) {
        EXPECT_EQ(nudged->find_family(normal), reading->find_family(normal));
    }
}

TEST(Nudge, LeavesAloneWhatFitsAndWhatIsTooFarOff) {
    const Reading houses = examples::find_solids("houses");
    Parameters parameters = sized(houses, {12, 8, 12});
    parameters.nudge = 5;
    EXPECT_EQ(ExampleReading::read_for(houses, parameters).value()->nudged(), nullptr);
    const Reading tent = read_pentagonal_tent();
    parameters = sized(tent, {12, 8, 12});
    parameters.nudge = 0.01;
    EXPECT_EQ(ExampleReading::read_for(tent, parameters).value()->nudged(), nullptr);
}

}  // namespace
}  // namespace modelsynth::continuous
