#include "solver/discrete/block_solver.h"

#include "solver/discrete/initial_model.h"
#include "solver/examples/built_in.h"
#include "tests/support/consistency_checker.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::find_inconsistency;

constexpr GridSize kSize = {20, 8, 20};

std::shared_ptr<Preparation> prepare() {
    const auto castle = examples::built_in().front();
    Parameters parameters;
    parameters.size = kSize;
    return Preparation::make(castle, fill_defaults(parameters, *castle)).value();
}

void expect_consistent(const Preparation& preparation, const std::vector<Label>& model) {
    EXPECT_EQ(find_inconsistency(preparation.example(), kSize, model), std::nullopt);
}

// The cells in which two models differ all lie in the box.
void expect_equal_outside(
    const std::vector<Label>& a, const std::vector<Label>& b, const Box& box
) {
    for (std::size_t site = 0; site < a.size(); ++site) {
        EXPECT_TRUE(a[site] == b[site] || box.contains(kSize.cell(site))) << site;
    }
}

// Without attempts every block fails, which brings up what is done then. A block of one column has
// no parts.
TEST(BlockSolver, LetsTheBorderOfABlockErodeThatHasNoParts) {
    const auto preparation = prepare();
    BlockSolver solver(*preparation, 1, {});
    std::vector<Label> model = *preparation->plain_model();
    bool any_outside = false;
    for (std::uint32_t index = 0; index < 30; ++index) {
        const std::vector<Label> before = model;
        const auto x = static_cast<std::int32_t>(2 + index % 15);
        const auto z = static_cast<std::int32_t>(2 + index / 3);
        const Box block = {{x, 0, z}, {x + 1, 8, z + 1}};
        const ModifiedBlock modified = solver.modify(model, block, index, 0);
        ASSERT_EQ(modified.result.outcome, BlockOutcome::kAccepted);
        EXPECT_EQ(modified.result.solved_by, SolvedBy::kErodedBorder);
        EXPECT_EQ(modified.changed, (Box{{x - 2, 0, z - 2}, {x + 3, 8, z + 3}}));
        EXPECT_EQ(solver.reach(block), modified.changed);
        expect_consistent(*preparation, model);
        expect_equal_outside(before, model, modified.changed);
        for (std::size_t site = 0; site < model.size(); ++site) {
            any_outside =
                any_outside || (model[site] != before[site] && !block.contains(kSize.cell(site)));
        }
    }
    EXPECT_TRUE(any_outside);
}

TEST(BlockSolver, MakesPartsOfABlockThatCannotBeMadeAsAWhole) {
    const auto preparation = prepare();
    BlockSolver solver(*preparation, 1, {});
    std::vector<Label> model = *preparation->plain_model();
    const std::vector<Label> before = model;
    const Box block = {{4, 0, 5}, {14, 8, 15}};
    const ModifiedBlock modified = solver.modify(model, block, 3, 0);
    ASSERT_EQ(modified.result.outcome, BlockOutcome::kAccepted);
    EXPECT_EQ(modified.result.solved_by, SolvedBy::kSmallerBlock);
    EXPECT_EQ(modified.changed, block);
    expect_consistent(*preparation, model);
    expect_equal_outside(before, model, block);
    EXPECT_NE(model, before);
}

TEST(BoxSearch, AsksCadicalAfterTheLastAttempt) {
    const auto preparation = prepare();
    const auto search = preparation->take_search();
    std::vector<Label> model = *preparation->plain_model();
    const std::vector<Label> before = model;
    const Box block = {{4, 0, 5}, {14, 8, 15}};
    BoxOptions options = {0, Order::kScan};
    const RandomKey key = {1, 0, 0, 0};
    EXPECT_EQ(search->modify(block, model, options, key, {}).outcome, BlockOutcome::kReverted);
    EXPECT_EQ(model, before);
    options.by_sat = SatLimits{1, 1};  // too little for any formula
    EXPECT_EQ(search->modify(block, model, options, key, {}).outcome, BlockOutcome::kReverted);
    EXPECT_EQ(model, before);
    options.by_sat = SatLimits{};
    const BlockResult result = search->modify(block, model, options, key, {});
    ASSERT_EQ(result.outcome, BlockOutcome::kAccepted);
    EXPECT_EQ(result.solved_by, SolvedBy::kSat);
    expect_consistent(*preparation, model);
    expect_equal_outside(before, model, block);
    EXPECT_NE(model, before);
    std::vector<Label> again = before;
    static_cast<void>(search->modify(block, again, options, key, {}));
    EXPECT_EQ(again, model);
}

}  // namespace
}  // namespace modelsynth::discrete
