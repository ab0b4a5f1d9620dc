#include "solver/registry/estimate.h"

#include "solver/examples/all.h"

#include <gtest/gtest.h>

namespace modelsynth {
namespace {

Task grid_task(std::int32_t side, const discrete::Parameters& given = {}) {
    discrete::Parameters parameters = given;
    parameters.size = GridSize{side, 10, side};
    Task task;
    task.example = *examples::find("castle");
    task.parameters = with_defaults(parameters, task.example);
    return task;
}

discrete::Parameters in_blocks(double overlap, std::uint32_t passes) {
    discrete::Parameters parameters;
    parameters.blocks = Blocks{{{10, 10, 10}, overlap, passes}};
    return parameters;
}

TEST(Estimate, CountsEachChoiceOfALabel) {
    // Half of a block along x and along z is made again by the next one.
    EXPECT_EQ(estimate(grid_task(40, in_blocks(0, 1))).choices, 16'000U);
    EXPECT_EQ(estimate(grid_task(40, in_blocks(0.5, 1))).choices, 64'000U);
    EXPECT_EQ(estimate(grid_task(40, in_blocks(0.5, 3))).choices, 192'000U);
    EXPECT_EQ(estimate(grid_task(40, in_blocks(0, 1)), 5).choices, 80'000U);
    EXPECT_EQ(estimate(grid_task(10, in_blocks(0.5, 1))).choices, 1000U);
    discrete::Parameters whole;
    whole.blocks.emplace();
    EXPECT_EQ(estimate(grid_task(40, whole)).choices, 16'000U);
}

TEST(Estimate, MemoryGrowsWithTheModelAndWithWhatItIsMadeUnder) {
    const std::uint64_t small = estimate(grid_task(40)).memory_bytes;
    const std::uint64_t large = estimate(grid_task(300)).memory_bytes;
    // Castles of these sizes were made in 20 and in 60 MB.
    EXPECT_GT(small, 16U << 20);
    EXPECT_GT(large, 60U << 20);
    EXPECT_LT(large, 600U << 20);
    discrete::Parameters whole;
    whole.blocks.emplace();
    EXPECT_GT(estimate(grid_task(40, whole)).memory_bytes, small);
    discrete::Parameters with_rule;
    with_rule.constraints.emplace_back();
    EXPECT_GT(estimate(grid_task(40, with_rule)).memory_bytes, small);
}

TEST(Estimate, SolidsWithMoreDirectionsOfFacesHaveMoreVertices) {
    const auto of = [](const char* name) {
        continuous::Parameters parameters;
        parameters.size = {24, 8, 24};
        parameters.spacing = 1;
        Task task;
        task.example = *examples::find(name);
        task.parameters = with_defaults(parameters, task.example);
        return estimate(task);
    };
    EXPECT_GT(of("houses").choices, of("skyscrapers").choices);
    EXPECT_GT(of("houses").memory_bytes, of("skyscrapers").memory_bytes);
}

}  // namespace
}  // namespace modelsynth
