// What the reader finds in an example of solids, beside what the checker of models sees there.

#include "solver/continuous/problem.h"
#include "solver/continuous/reading/reading.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/random_solids.h"
#include "tests/support/surface_checker.h"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using testing::make_random_solids;
using testing::SolidsKind;
using testing::SurfaceChecker;

// What the reader and the checker find in an example, each by its own means, is the same; but what
// is all one is nothing that the checker looks for.
void expect_seen(const ExampleReading& reading) {
    const SurfaceChecker checker(reading.example());
    const Topes& topes = reading.topes();
    ASSERT_EQ(checker.cells().count(), checker.cells().expected_count());
    ASSERT_EQ(checker.cells().count(), topes.count());
    std::vector<Tope> tope_of;
    for (std::size_t cell = 0; cell < topes.count(); ++cell) {
        FamilySet sides = 0;
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            const bool is_positive = topes.normals()[family].dot(checker.cells().inside(cell)) > 0;
            sides |= is_positive ? FamilySet{1} << family : 0;
        }
        tope_of.push_back(topes.tope_of(sides));
    }
    const auto is_all_one = [](const std::string& figure) {
        return figure.find_first_not_of(figure.front()) == std::string::npos;
    };
    std::set<std::string> read;
    for (std::size_t label = 0; label < reading.figures().count(); ++label) {
        std::string figure;
        for (const Tope tope : tope_of) {
            figure.push_back(reading.figures().at(static_cast<Label>(label))[tope]);
        }
        if (!is_all_one(figure)) {
            read.insert(std::move(figure));
        }
    }
    std::set<std::string> seen = checker.figures();
    std::erase_if(seen, is_all_one);
    EXPECT_EQ(read, seen);
}

TEST(SolidsReading, SeesInBuiltInExamplesWhatIsThere) {
    for (const auto& reading : examples::built_in_solids()) {
        SCOPED_TRACE(reading->example().name);
        expect_seen(*reading);
    }
}

// Slivers are left out: what comes as near as the tolerance may be seen in either way.
TEST(SolidsReading, SeesInRandomSolidsWhatIsThere) {
    for (const SolidsKind kind :
         {SolidsKind::kBoxes, SolidsKind::kWedges, SolidsKind::kTetrahedra, SolidsKind::kConvex}) {
        std::size_t read = 0;
        for (std::uint32_t seed = 0; seed < 100; ++seed) {
            SCOPED_TRACE(
                "kind " + std::to_string(static_cast<int>(kind)) + ", seed " + std::to_string(seed)
            );
            Example example = make_random_solids(kind, seed);
            example.bounds.reset();  // see below
            const auto reading = ExampleReading::make(std::move(example));
            if (reading) {
                expect_seen(**reading);
                ++read;
            }
        }
        EXPECT_GT(read, 50U);
    }
}

Example make_example(std::vector<Polyhedron> solids) {
    Example example;
    example.name = "test";
    example.materials = {{"ground", {}}, {"one", {}}, {"other", {}}};
    example.objects = {{"ground", 0}, {"one", 1}, {"other", 2}};
    example.polyhedra = std::move(solids);
    return example;
}

// A wall that goes through a floor, both beyond the bounds: where they meet is an edge of neither.
TEST(SolidsReading, SeesWhereFacesCrossThatEndBeyondTheBounds) {
    Example example = make_example(
        {box(2, {-9, -9, -9}, {9, 1, 9}),
         box(3, {1, -9, -9}, {2, 3, 9}),
         box(2, {-3, 4, -3}, {-2, 5, -2})}
    );
    example.bounds = Bounds{{-4, 0.5, -4}, {4, 6, 4}};
    expect_seen(*ExampleReading::make(example).value());
}

// The ground is bare all over.
TEST(SolidsReading, SeesTheGroundBelowWhatFloats) {
    Example example = make_example({box(2, {2, 1, 0}, {3, 2, 2})});
    example.ground = ObjectId{1};
    const auto reading = ExampleReading::make(example);
    ASSERT_TRUE(reading) << reading.error().message;
    expect_seen(**reading);
}

// Every vertex may be what the initial model has there; else synthesise() takes a block for
// impossible. Where planes of nearly equal slopes meet, vertices come within a millionth of the
// ground's top without being on it.
TEST(SolidsReading, BeginsWithWhatVerticesMayBe) {
    for (const std::uint32_t seed : {277U, 444U, 1011U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto reading = ExampleReading::make(make_random_solids(SolidsKind::kSlivers, seed));
        const Figures& figures = (*reading)->figures();
        Parameters parameters;
        parameters.size = {4, 3, 4};
        parameters = fill_defaults(parameters, (*reading)->example());
        const Problem problem = make_problem(*reading, parameters).value();
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < problem.arrangement.vertex_count(); ++i) {
            const FamilySet families = problem.arrangement.families(static_cast<Site>(i));
            wrong += (figures.relevant(problem.initial[i]) & ~families) != 0 ? 1U : 0U;
        }
        EXPECT_EQ(wrong, 0U);
    }
}

}  // namespace
}  // namespace modelsynth::continuous
