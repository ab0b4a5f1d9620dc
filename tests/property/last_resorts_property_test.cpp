// Blocks that every attempt fails at are made in parts, and none is given up.

#include "solver/discrete/preparation.h"
#include "solver/discrete/synthesis.h"
#include "tests/bench/planar_problems.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <string>

namespace modelsynth::discrete {
namespace {

using testing::find_inconsistency;
using testing::RecordingObserver;

std::uint32_t count(const SearchTally& tally, SolvedBy what) {
    return tally.solved_by.at(static_cast<std::size_t>(what));
}

// One attempt in an order that suits no tileset, at blocks large enough to fail.
Parameters hard_parameters(const Example& example) {
    Parameters parameters;
    parameters.size = GridSize{66, 1, 60};
    Blocks blocks;
    blocks.layout.size = {30, 1, 30};
    blocks.attempts = 1;
    parameters.blocks = blocks;
    parameters.order.order = Order::kRandom;
    return fill_defaults(parameters, example);
}

TEST(LastResorts, LeaveEveryStateConsistentAndOnAnyNumberOfThreadsTheSame) {
    SearchTally all;
    for (const auto& example : bench::make_planar_tilesets()) {
        const Parameters parameters = hard_parameters(*example);
        const auto preparation = Preparation::make(example, parameters).value();
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            const std::string where = example->name + ", seed " + std::to_string(seed);
            RecordingObserver observer;
            const auto made = synthesise(*preparation, seed, observer, {});
            ASSERT_TRUE(made) << where << ": " << made.error().message;
            std::vector<Label> before = observer.initial_model;
            for (std::size_t block = 0; block < observer.models.size(); ++block) {
                const std::vector<Label>& after = observer.models[block];
                ASSERT_EQ(find_inconsistency(*example, *parameters.size, after), std::nullopt)
                    << where << ", block " << block;
                for (std::size_t site = 0; site < after.size(); ++site) {
                    ASSERT_TRUE(
                        after[site] == before[site] ||
                        (observer.reports[block].accepted &&
                         observer.reports[block].region.contains(parameters.size->cell(site)))
                    ) << where
                      << ", block " << block << " changed a cell outside its region";
                }
                before = after;
            }
            for (std::size_t i = 0; i < kSolvedByCount; ++i) {
                all.solved_by.at(i) += made->stats.blocks.solved_by.at(i);
            }
            all.reverted += made->stats.blocks.reverted;
            RecordingObserver beside;
            const auto parallel = synthesise(*preparation, seed, beside, {}, nullptr, 3).value();
            EXPECT_EQ(parallel.labels, made->labels) << where;
            EXPECT_EQ(beside.models, observer.models) << where;
        }
    }
    EXPECT_GT(count(all, SolvedBy::kSmallerBlock), 0U);
    EXPECT_EQ(all.reverted, 0U);
}

}  // namespace
}  // namespace modelsynth::discrete
