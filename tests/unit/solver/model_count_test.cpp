#include "solver/discrete/analysis/model_count.h"

#include "tests/support/examples.h"
#include "tests/support/naive_grid.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::make_example;
using testing::make_random_example;
using testing::NaiveGrid;
using testing::NaiveRules;

constexpr std::uint64_t kCountMax = std::numeric_limits<std::uint64_t>::max();

ModelCount count(const Example& example, const GridSize& size, const ModelCountLimit& limit = {}) {
    return count_models(read_transitions(example), size, limit, {}).value();
}

std::uint64_t count_by_brute_force(const Example& example, const GridSize& size) {
    const NaiveRules rules(example);
    return NaiveGrid(rules, size).count_completions(kCountMax);
}

const std::vector<GridSize> kSizes = {
    {1, 1, 1},
    {4, 1, 1},
    {1, 3, 1},
    {1, 1, 4},
    {2, 1, 3},
    {3, 1, 2},
    {3, 1, 3},
    {2, 2, 2},
    {2, 3, 1}};

TEST(ModelCount, AgreesWithBruteForce) {
    std::size_t several = 0;
    std::size_t none = 0;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
        const Example example = make_random_example(seed);
        for (const GridSize& size : kSizes) {
            const std::uint64_t expected = count_by_brute_force(example, size);
            EXPECT_EQ(count(example, size), (ModelCount{expected, true})) << "seed " << seed;
            several += std::size_t{expected > 1};
            none += std::size_t{expected == 0};
        }
    }
    EXPECT_GT(several, 300U);
    EXPECT_GT(none, 30U);
}

// The same where cross-sections are too many to be kept: one model after the other.
TEST(ModelCount, CountsOneByOneWhatItCannotCountTogether) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const Example example = make_random_example(seed);
        for (const GridSize& size : kSizes) {
            const std::uint64_t expected = count_by_brute_force(example, size);
            EXPECT_EQ(count(example, size, {0, 10'000'000}), (ModelCount{expected, true})) << seed;
            for (const std::uint64_t steps : {3U, 30U}) {
                const ModelCount least = count(example, size, {0, steps});
                EXPECT_LE(least.count, expected) << seed;
                EXPECT_TRUE(!least.is_exact || least.count == expected) << seed;
            }
        }
    }
    const Example noise = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    EXPECT_TRUE(count(noise, {3, 1, 3}).is_exact);
    EXPECT_EQ(count(testing::make_pillars(), {8, 4, 8}, {0, 1'000}).is_exact, false);
    EXPECT_GT(count(testing::make_pillars(), {8, 4, 8}, {0, 1'000}).count, 100U);
}

// The thesis (3.2): empty space has one model of any size, a chequerboard two, and labels that do
// not repeat have none that is larger than the example.
TEST(ModelCount, IsThatOfTheThesissExamples) {
    const Example empty = make_example({2, 1, 2}, {0, 0, 0, 0}, 1);
    const Example chequers = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    const Example unlike = make_example({2, 1, 2}, {0, 1, 2, 3}, 4);
    for (const std::int32_t side : {2, 5, 12}) {
        EXPECT_EQ(count(empty, {side, 1, side}), (ModelCount{1, true}));
        EXPECT_EQ(count(unlike, {side, 1, side}), (ModelCount{side == 2 ? 1U : 0U, true}));
    }
    // What stands on a chequerboard of 2 x 2: along x 0 1 and 1 0, along z likewise.
    EXPECT_EQ(count(chequers, {12, 1, 12}), (ModelCount{2, true}));
    EXPECT_EQ(count(chequers, {2, 2, 2}), (ModelCount{0, true}));
}

TEST(ModelCount, SaysAtLeastWhereThereAreMoreThanANumberHolds) {
    // Any two labels side by side: 2^(x * z) models.
    const Example any =
        make_example({4, 1, 4}, {0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 0, 0, 0, 0, 1, 1}, 2);
    EXPECT_EQ(count(any, {7, 1, 9}), (ModelCount{std::uint64_t{1} << 63, true}));
    EXPECT_EQ(count(any, {8, 1, 8}), (ModelCount{kCountMax, false}));
    EXPECT_EQ(count(any, {9, 1, 8}), (ModelCount{kCountMax, false}));
}

TEST(ModelCount, RefusesLargeModelsAndStopsWhenAsked) {
    const Transitions transitions = read_transitions(testing::make_pillars());
    const auto large = count_models(transitions, {17, 16, 16}, {}, {});
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().code, ErrorCode::kTooLarge);
    std::stop_source stop;
    stop.request_stop();
    const auto stopped = count_models(transitions, {4, 4, 4}, {}, stop.get_token());
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace modelsynth::discrete
