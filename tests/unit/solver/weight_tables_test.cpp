#include "solver/core/weight_tables.h"

#include <gtest/gtest.h>

namespace modelsynth::discrete {
namespace {

LabelSet only(Label label) {
    LabelSet set(3);
    set.insert(label);
    return set;
}

TEST(WeightTables, AreSharedByTheSitesWhoseProductsAreTheSame) {
    WeightTables tables(4, {1, 1, 1});
    ASSERT_TRUE(tables.multiply(1, 0, only(0), 0.5));
    ASSERT_TRUE(tables.multiply(2, 0, only(0), 0.5));
    ASSERT_TRUE(tables.multiply(2, 1, only(2), 2));
    const SiteWeights weights = std::move(tables).finish();
    EXPECT_EQ(weights.number(0), 0);
    EXPECT_EQ(weights.number(3), 0);
    EXPECT_EQ(weights.number(1), 1);
    EXPECT_EQ(weights.number(2), 2);
    EXPECT_EQ(weights.at(1).of(1), 2 * weights.at(1).of(0));
    EXPECT_EQ(weights.at(2).of(2), 4 * weights.at(2).of(0));
    EXPECT_EQ(weights.at(0).of(0), weights.at(0).of(2));
}

TEST(WeightTables, OfOneKindNeedNoNumbers) {
    EXPECT_TRUE(WeightTables(4, {1, 2, 3}).finish().is_same_everywhere());
}

// However many hostile factors come together, what is made of them are weights.
TEST(WeightTables, KeepWeightsPositiveAndFinite) {
    WeightTables tables(2, {1, 1, 0});
    for (std::size_t rule = 0; rule < 100; ++rule) {
        ASSERT_TRUE(tables.multiply(0, rule, only(0), 1e6));
        ASSERT_TRUE(tables.multiply(1, rule, only(0), 1e-6));
        ASSERT_TRUE(tables.multiply(1, rule, only(2), 1e6));
    }
    const SiteWeights weights = std::move(tables).finish();
    EXPECT_EQ(weights.at(0).of(0), LabelWeights::kLargest);
    EXPECT_GT(weights.at(0).of(1), 0U);
    EXPECT_GT(weights.at(1).of(0), 0U);
    EXPECT_EQ(weights.at(1).of(2), 0U);
}

TEST(WeightTables, AreNoMoreThanTheLimit) {
    WeightTables tables(kWeightTablesMax + 1, {1, 1, 1});
    for (std::size_t site = 1; site < kWeightTablesMax; ++site) {
        ASSERT_TRUE(
            tables.multiply(static_cast<Site>(site), 0, only(0), static_cast<double>(site) + 1)
        );
    }
    // Another product is one too many; a known one is not.
    EXPECT_FALSE(tables.multiply(static_cast<Site>(kWeightTablesMax), 0, only(0), 0.25));
    EXPECT_TRUE(tables.multiply(static_cast<Site>(kWeightTablesMax), 0, only(0), 2));
}

}  // namespace
}  // namespace modelsynth::discrete
