// Models of solids with free sides, turned variants, jitter and perturbation, checked by what one
// sees of them.

#include "solver/continuous/faults.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "tests/support/case_count.h"
#include "tests/support/examples.h"
#include "tests/support/random_solids.h"
#include "tests/support/surface_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>

namespace modelsynth::continuous {
namespace {

using testing::CutSides;
using testing::make_random_solids;
using testing::ModelFaults;
using testing::RecordingObserver;
using testing::solid_case_count;
using testing::SolidsKind;
using testing::SurfaceChecker;

using Reading = std::shared_ptr<const ExampleReading>;

std::string text(const ModelFaults& faults) {
    std::string all;
    for (const std::string& fault : faults) {
        all += fault + "\n";
    }
    return all;
}

// Every kind of example turned about the upright axis, and mirrored across x: by hand, with what
// turns be left as it is. Copies stand far from each other.
Example with_turned_copies(const Example& example, int turns, bool mirrored) {
    Example copies = example;
    double far = 100;
    for (int turn = 0; turn < turns * (mirrored ? 2 : 1); ++turn) {
        const int quarters = turn % turns * (4 / turns);
        const bool is_mirrored = turn >= turns;
        if (turn == 0) {
            continue;
        }
        for (Polyhedron solid : example.polyhedra) {
            const std::string name =
                example.objects[solid.object - 1U].name + (is_mirrored ? " mirrored" : "") +
                (quarters == 0 ? "" : " turned " + std::to_string(90 * quarters));
            const ObjectId apart = find_object(example, name);
            solid.object = apart == kEmpty ? solid.object : apart;
            for (Point& corner : solid.corners) {
                corner.x() *= is_mirrored ? -1 : 1;
                for (int i = 0; i < quarters; ++i) {
                    corner = Point(corner.z(), corner.y(), -corner.x());
                }
                corner.x() += far;
            }
            if (is_mirrored) {
                for (Face& face : solid.faces) {
                    std::reverse(face.begin(), face.end());
                }
            }
            copies.polyhedra.push_back(std::move(solid));
        }
        far += 100;
    }
    return copies;
}

struct Options {
    Parameters parameters;
    CutSides cuts = {};
};

// `random` decides what is asked for.
Options random_options(const Example& example, double extent, std::mt19937& random) {
    Options options;
    options.parameters.size = {extent, std::max(3.0, extent - 2), extent + 1};
    for (std::size_t side = 0; side < options.cuts.size(); ++side) {
        if (random() % 2 == 0) {
            options.parameters.boundary[side] = SideKind::kFree;
            options.cuts[side] = true;
        }
    }
    options.parameters.jitter = random() % 2 == 0 ? 0.4 : 0;
    options.parameters.perturbation = random() % 2 == 0 ? 0.3 : 0;

    options.parameters = fill_defaults(options.parameters, example);
    return options;
}

// Whether a model was made, rather than refused.
bool expect_right(
    const Reading& reading,
    const Options& options,
    const SurfaceChecker& checker,
    std::uint64_t seed
) {
    if (!find_faults(*reading, options.parameters).empty()) {
        return false;
    }
    const auto problem = make_problem(reading, options.parameters);
    if (!problem) {
        EXPECT_NE(problem.error().code, ErrorCode::kInternal) << problem.error().message;
        return false;
    }
    RecordingObserver observer;
    const auto made = synthesise(*problem, options.parameters, seed, observer, {});
    if (!made) {
        EXPECT_EQ(made.error().code, ErrorCode::kGaveUp) << made.error().message;
        return false;
    }
    const Surface surface = make_surface(*problem, made->labels);
    const Eigen::AlignedBox3d box(problem->box.min, problem->box.max);
    EXPECT_EQ(text(checker.find_faults(surface, box, 5000, options.cuts)), "");
    EXPECT_EQ(text(checker.find_faults(make_scene(*reading, surface), surface)), "");
    return true;
}

class OptionsOfBuiltIns : public ::testing::TestWithParam<std::size_t> {
  protected:
    [[nodiscard]] static Reading reading() { return examples::built_in_solids()[GetParam()]; }
};

TEST_P(OptionsOfBuiltIns, LeaveAllStandingAsInTheExample) {
    const SurfaceChecker checker(reading()->example());
    std::mt19937 random(7);
    std::size_t models = 0;
    for (std::uint64_t seed = 1; seed <= solid_case_count(12); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const double extent = 6 + static_cast<double>(random() % 9) / 2;
        const Options options = random_options(reading()->example(), extent, random);
        models += std::size_t{expect_right(reading(), options, checker, seed)};
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GT(models, solid_case_count(12) / 2);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    OptionsOfBuiltIns,
    ::testing::Range<std::size_t>(0, examples::built_in_solids().size()),
    [](const auto& tested) { return examples::built_in_solids()[tested.param]->example().name; }
);

class OptionsOfRandomSolids : public ::testing::TestWithParam<SolidsKind> {};

TEST_P(OptionsOfRandomSolids, LeaveAllStandingAsInTheExample) {
    std::mt19937 random(11);
    std::size_t models = 0;
    for (std::uint32_t seed = 0; seed < solid_case_count(40); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Example example = make_random_solids(GetParam(), seed);
        const auto reading = ExampleReading::make(example);
        if (!reading) {
            continue;
        }
        const double extent = (*reading)->topes().family_count() > 7 ? 3 : 5;
        const Options options = random_options(example, extent, random);
        models += std::size_t{expect_right(*reading, options, SurfaceChecker(example), seed)};
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GE(models, solid_case_count(8));
    }
}

TEST_P(OptionsOfRandomSolids, MayStandTurnedAndMirrored) {
    if (GetParam() == SolidsKind::kSlivers) {
        GTEST_SKIP() << "copies far from each other leave slivers too thin for the checker";
    }
    std::mt19937 random(13);
    std::size_t models = 0;
    for (std::uint32_t seed = 0; seed < solid_case_count(30); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Example example = make_random_solids(GetParam(), seed);
        const auto plain = ExampleReading::make(example);
        if (!plain || example.bounds) {
            continue;
        }
        const int turns = 1 << random() % 3;
        const bool mirrored = random() % 2 == 0;
        Options options = random_options(example, 4, random);
        options.parameters.variants = {static_cast<std::uint8_t>(turns), mirrored, false};
        const auto reading = ExampleReading::read_for(*plain, options.parameters);
        if (!reading) {
            EXPECT_EQ(reading.error().code, ErrorCode::kTooLarge) << reading.error().message;
            continue;
        }
        if ((*reading)->topes().family_count() > 9) {
            continue;  // more vertices than a test has time for
        }
        const SurfaceChecker checker(with_turned_copies((*reading)->example(), turns, mirrored));
        models += std::size_t{expect_right(*reading, options, checker, seed)};
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GE(models, solid_case_count(4));
    }
}

std::string name_of(const ::testing::TestParamInfo<SolidsKind>& tested) {
    constexpr std::array<const char*, testing::kSolidsKindCount> kNames = {
        "Boxes", "Wedges", "Tetrahedra", "Convex", "Slivers"};
    return kNames.at(static_cast<std::size_t>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    OptionsOfRandomSolids,
    ::testing::Values(
        SolidsKind::kBoxes,
        SolidsKind::kWedges,
        SolidsKind::kTetrahedra,
        SolidsKind::kConvex,
        SolidsKind::kSlivers
    ),
    name_of
);

}  // namespace
}  // namespace modelsynth::continuous
