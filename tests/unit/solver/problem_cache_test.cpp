#include "solver/continuous/problem_cache.h"

#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace modelsynth::continuous {
namespace {

using testing::RecordingObserver;

using Reading = std::shared_ptr<const ExampleReading>;

Parameters sized(const Reading& reading, double width) {
    Parameters parameters;
    parameters.size = {width, 8, 12};
    parameters.constraints = {{SymmetryRule{SymmetryRule::Kind::kReflectZ}}};
    return fill_defaults(parameters, reading->example());
}

std::vector<Label> labels_of(
    const Problem& problem, const Parameters& parameters, std::uint64_t seed
) {
    RecordingObserver observer;
    return synthesise(problem, parameters, seed, observer, {}).value().labels;
}

TEST(ProblemCache, GivesOneProblemToAllThatAskForTheSame) {
    const Reading houses = examples::find_solids("houses");
    const Reading stairs = examples::find_solids("stairs");
    ProblemCache cache;
    const auto first = cache.find_or_make(houses, sized(houses, 12)).value();
    EXPECT_EQ(cache.find_or_make(houses, sized(houses, 12)).value(), first);
    EXPECT_NE(cache.find_or_make(houses, sized(houses, 13)).value(), first);
    EXPECT_NE(cache.find_or_make(stairs, sized(stairs, 12)).value(), first);
    EXPECT_EQ(cache.find_or_make(houses, sized(houses, 12)).value(), first);
}

TEST(ProblemCache, ThreadsThatShareAProblemMakeWhatEachMakesAlone) {
    const Reading houses = examples::find_solids("houses");
    const std::array<double, 2> widths = {10, 14};
    constexpr std::size_t kThreads = 4;
    std::array<std::vector<Label>, kThreads> made;
    ProblemCache cache;
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < kThreads; ++i) {
            threads.emplace_back([&, i] {
                const Parameters parameters = sized(houses, widths.at(i % 2));
                const auto problem = cache.find_or_make(houses, parameters).value();
                made.at(i) = labels_of(*problem, parameters, i);
            });
        }
    }
    for (std::size_t i = 0; i < kThreads; ++i) {
        const Parameters parameters = sized(houses, widths.at(i % 2));
        const Problem alone = make_problem(houses, parameters).value();
        EXPECT_EQ(made.at(i), labels_of(alone, parameters, i));
        EXPECT_NE(made.at(i), alone.initial);
    }
}

}  // namespace
}  // namespace modelsynth::continuous
