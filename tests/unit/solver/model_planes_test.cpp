// Planes of a continuous model by family: how far apart, or one by one.

#include "solver/continuous/planes/model_planes.h"

#include "solver/continuous/faults.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/continuous/warnings.h"
#include "solver/examples/solids/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using examples::Outline;
using examples::pyramid;

using Reading = std::shared_ptr<const ExampleReading>;

Reading read_on_grass(Polyhedron solid) {
    Example example;
    example.name = "plain";
    example.materials = {{"grass", {}}, {"wall", {}}};
    example.objects = {{"grass", 0}, {"wall", 1}};
    example.polyhedra = {std::move(solid)};
    example.ground = ObjectId{1};
    example.density = 1;
    return ExampleReading::make(std::move(example)).value();
}

constexpr ObjectId kWall = 2;

Reading boxes() { return read_on_grass(box(kWall, {0, 0, 0}, {1, 1, 1})); }

// Sides that rise from an even polygon to a point one metre above its middle.
Reading pointed(int sides) {
    Outline outline;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        outline.push_back({std::cos(angle), std::sin(angle)});
    }
    return read_on_grass(pyramid(kWall, outline, 0, {0, 1, 0}));
}

Parameters of_size(const Reading& reading, const std::array<double, 3>& size) {
    Parameters parameters;
    parameters.size = size;
    return fill_defaults(parameters, reading->example());
}

std::array<double, 3> numbers_of(const Point& point) { return {point.x(), point.y(), point.z()}; }

class Silent final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport&) override {}
};

Surface make(const Problem& problem, const Parameters& parameters, std::uint64_t seed) {
    Silent silent;
    return make_surface(problem, synthesise(problem, parameters, seed, silent, {})->labels);
}

// Where walls end along an axis, in thousandths of a metre.
std::set<long> ends_along(const Surface& surface, const Topes& topes, int axis) {
    std::set<long> ends;
    for (const SurfacePolygon& polygon : surface.polygons) {
        if (polygon.object != kWall || std::abs(topes.normals()[polygon.family][axis]) < 0.9) {
            continue;
        }
        for (const std::uint32_t point : polygon.loops.front()) {
            ends.insert(std::lround(1000 * surface.points[point][axis]));
        }
    }
    return ends;
}

void expect_consistent(const Problem& problem) {
    const Arrangement& arrangement = problem.arrangement;
    for (std::size_t i = 0; i < arrangement.vertex_count(); ++i) {
        const auto site = static_cast<Site>(i);
        EXPECT_TRUE(problem.domains.at(site).contains(problem.initial[site]));
        for (const ArrangementEdge& edge : arrangement.edges(site)) {
            EXPECT_TRUE(
                edge.end == kNoSite ||
                problem.reading->relations().allows(
                    edge.heading, problem.initial[site], problem.initial[edge.end]
                )
            ) << arrangement.position(site).transpose();
        }
    }
}

TEST(ModelPlanes, LieWhereTheyAreListed) {
    const Reading reading = boxes();
    Parameters parameters = of_size(reading, {9, 4, 9});
    // In any order, some of them one plane or outside, along the normal as it is asked for.
    parameters.offsets = {{{-3, 0, 0}, {-7.25, -0.5, 1, -2, -2.0000001, -9, -40}}};
    const Problem problem = make_problem(reading, parameters).value();
    const std::size_t across_x = *reading->topes().find_family({1, 0, 0});
    const PlaneOffsets& planes = problem.arrangement.planes(across_x);
    ASSERT_EQ(planes.size(), 3U);
    EXPECT_EQ(planes[0], 0.5);
    EXPECT_NEAR(planes[1], 2, 1e-6);
    EXPECT_EQ(planes[2], 7.25);
    const Surface surface = make(problem, parameters, 1);
    EXPECT_EQ(ends_along(surface, reading->topes(), 0), (std::set<long>{500, 2000, 7250}));
    EXPECT_GT(ends_along(surface, reading->topes(), 2).size(), 3U);
}

TEST(ModelPlanes, AreSpacedByFamily) {
    const Reading reading = boxes();
    Parameters parameters = of_size(reading, {12, 4, 12});
    parameters.spacings = {{{2, 0, 0}, 2.5}};
    const Problem problem = make_problem(reading, parameters).value();
    const Surface surface = make(problem, parameters, 1);
    EXPECT_EQ(ends_along(surface, reading->topes(), 0), (std::set<long>{2500, 5000, 7500, 10000}));
    for (const long end : ends_along(surface, reading->topes(), 2)) {
        EXPECT_EQ(end % 1000, 0);
    }
}

TEST(ModelPlanes, FollowThoseThatAreGiven) {
    const Reading reading = pointed(4);
    Parameters parameters = of_size(reading, {12, 4, 12});
    const Topes& topes = reading->topes();
    std::size_t slope = 0;
    while (topes.normals()[slope].y() > 0.9) {
        ++slope;
    }
    parameters.spacings = {{numbers_of(topes.normals()[slope]), 3}};
    const Spacings spacings = spacings_of(*reading, parameters);
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        EXPECT_NEAR(spacings.of_family[family], topes.normals()[family].y() > 0.9 ? 1 : 3, 1e-9);
    }
    // Nothing follows from planes that are listed.
    parameters.offsets = {{parameters.spacings.front().normal, {1, 2}}};
    parameters.spacings.clear();
    const Spacings without = spacings_of(*reading, parameters);
    EXPECT_EQ(without.of_family[slope], 0);
    EXPECT_TRUE(without.conflicts.empty());
}

TEST(ModelPlanes, KeepTheGroundWhereItIs) {
    const Reading reading = boxes();
    Parameters parameters = of_size(reading, {6, 3, 6});
    // Several planes between the ground and the bottom of the model.
    parameters.spacings = {{{0, 1, 0}, 0.1}};
    const Problem fine = make_problem(reading, parameters).value();
    EXPECT_LT(fine.arrangement.planes(*reading->horizontal()).front(), -0.15);
    expect_consistent(fine);
    // A list without the ground's own plane, or with one very near to it.
    parameters.spacings.clear();
    for (const double low : {0.75, 1e-8}) {
        parameters.offsets = {{{0, 1, 0}, {2.25, low}}};
        const Problem listed = make_problem(reading, parameters).value();
        const PlaneOffsets& planes = listed.arrangement.planes(*reading->horizontal());
        EXPECT_EQ(planes, (low > 0.5 ? PlaneOffsets{0, 0.75, 2.25} : PlaneOffsets{0, 2.25}));
        expect_consistent(listed);
    }
}

TEST(ModelPlanes, OfAListAreCountedForDimensions) {
    const Reading reading = boxes();
    Parameters parameters = of_size(reading, {10, 3, 10});
    // The first one counts, though the model ends there.
    parameters.offsets = {{{1, 0, 0}, {0, 1, 3, 4, 8, 9}}};
    parameters.constraints = {{DimensionRule{{1, 0, 0}, 2}, {"wall"}}};
    const Problem problem = make_problem(reading, parameters).value();
    std::set<long> ends;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        ends.merge(ends_along(make(problem, parameters, seed), reading->topes(), 0));
    }
    EXPECT_EQ(ends, (std::set<long>{3000, 8000}));
}

TEST(ModelPlanes, ThroughAPointLetFiveMeetThere) {
    const Reading reading = pointed(5);
    Parameters parameters = of_size(reading, {8, 4, 8});
    const Problem spaced = make_problem(reading, parameters).value();
    ASSERT_FALSE(spaced.homeless.empty());
    const std::vector<std::string> warnings = warnings_of(spaced);
    ASSERT_FALSE(warnings.empty());
    const std::string count = std::to_string(reading->figures().count());
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
        return warning == "1 of " + count +
                              " figures has no place: no point of the model has "
                              "planes of families h2, h3, h4, h5 and h6 at once";
    })) << warnings.front();
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
        return warning.find("spacings do not fit") != std::string::npos;
    }));

    const Point apex(4.1, 1.3, 3.9);
    for (const Point& normal : reading->topes().normals()) {
        if (normal.y() < 0.9) {
            parameters.offsets.push_back({numbers_of(normal), {normal.dot(apex)}});
        }
    }
    const Problem listed = make_problem(reading, parameters).value();
    EXPECT_TRUE(listed.homeless.empty());
    EXPECT_TRUE(warnings_of(listed).empty());
    bool is_pointed = false;
    for (std::uint64_t seed = 0; seed < 20 && !is_pointed; ++seed) {
        for (const Point& point : make(listed, parameters, seed).points) {
            is_pointed = is_pointed || (point - apex).norm() < 1e-9;
        }
    }
    EXPECT_TRUE(is_pointed);
}

TEST(ModelPlanes, WarnOfSoMuchOnly) {
    const Reading reading = pointed(9);
    const Problem problem = make_problem(reading, of_size(reading, {4, 3, 4})).value();
    ASSERT_GT(problem.spacings.conflicts.size(), kWarningsMax);
    const std::vector<std::string> warnings = warnings_of(problem);
    ASSERT_EQ(warnings.size(), kWarningsMax);
    EXPECT_EQ(warnings.back().rfind("and ", 0), 0U) << warnings.back();
}

std::vector<std::string> fault_pointers(const Reading& reading, const Parameters& parameters) {
    std::vector<std::string> pointers;
    for (const Fault& fault : find_faults(*reading, parameters)) {
        pointers.push_back(fault.pointer);
    }
    return pointers;
}

using Pointers = std::vector<std::string>;

TEST(ModelPlanes, AreRefusedWhereTheExampleHasNone) {
    const Reading reading = boxes();
    Parameters parameters = of_size(reading, {9, 4, 9});
    parameters.spacings = {{{1, 0, 0}, 2}, {{1, 1, 0}, 2}, {{-2, 0, 0}, 3}};
    parameters.offsets = {{{0, 0, 1}, {1}}, {{0, 0, -1}, {2}}, {{5, 0, 0}, {3}}, {{0, 2, 1}, {3}}};
    EXPECT_EQ(
        fault_pointers(reading, parameters),
        (Pointers{
            "/spacing/1/normal",
            "/spacing/2/normal",
            "/offsets/1/normal",
            "/offsets/2/normal",
            "/offsets/3/normal"})
    );
    // A normal of no length is a fault of its own, and no planes are made of it.
    parameters.spacings = {{{0, 0, 0}, 2}};
    parameters.offsets = {{{0, 0, 0}, {1}}};
    EXPECT_EQ(fault_pointers(reading, parameters), Pointers{});
    // So is a dimension that names no object.
    parameters = of_size(reading, {9, 4, 9});
    parameters.constraints = {{DimensionRule{{1, 0, 0}, 1}, {}}};
    EXPECT_EQ(fault_pointers(reading, parameters), Pointers{});
}

TEST(ModelPlanes, AreRefusedWhereThereAreTooMany) {
    const Reading reading = boxes();
    Parameters parameters = of_size(reading, {9, 4, 9});
    for (const double spacing : {5e-324, 1e-9, 1e-4}) {
        parameters.spacings = {{{1, 0, 0}, spacing}};
        EXPECT_EQ(fault_pointers(reading, parameters), Pointers{"/spacing"}) << spacing;
    }
    // Few enough of one direction, and too many places where three meet.
    parameters.spacings = {{{1, 0, 0}, 0.01}, {{0, 0, 1}, 0.01}, {{0, 1, 0}, 0.05}};
    EXPECT_EQ(fault_pointers(reading, parameters), Pointers{"/size"});
    parameters.spacings.pop_back();
    EXPECT_EQ(fault_pointers(reading, parameters), Pointers{});
    // However long the lists are.
    parameters.spacings.clear();
    std::vector<double> offsets;
    for (std::size_t i = 0; i < kOffsetsMax; ++i) {
        offsets.push_back(1 + 1e-3 * static_cast<double>(i));
    }
    parameters.offsets = {{{1, 0, 0}, offsets}};
    EXPECT_EQ(fault_pointers(reading, parameters), Pointers{});
    parameters.offsets.push_back({{0, 0, 1}, offsets});
    EXPECT_EQ(fault_pointers(reading, parameters), Pointers{"/size"});
    EXPECT_TRUE(find_faults(*reading, parameters).front().over_limit);
}

}  // namespace
}  // namespace modelsynth::continuous
