#include "solver/registry/alternatives.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

namespace modelsynth {
namespace {

constexpr std::uint64_t kSeedMax = (std::uint64_t{1} << 53) - 1;

TEST(Alternatives, TheFirstSeedIsTheRequestsAndTheOthersAreApart) {
    Alternatives series(kSeedMax, 1000);
    std::set<std::uint64_t> seeds;
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t seed = series.next_seed();
        EXPECT_LE(seed, kSeedMax);
        EXPECT_EQ(seed, series.next_seed());
        seeds.insert(seed);
        EXPECT_FALSE(series.add(std::to_string(i)));
    }
    EXPECT_EQ(seeds.size(), 1000U);
    EXPECT_TRUE(seeds.contains(kSeedMax));
    EXPECT_EQ(Alternatives(7, 2).next_seed(), 7U);
    EXPECT_TRUE(series.is_complete());
}

TEST(Alternatives, AModelThatWasThereIsToldAndNotCounted) {
    Alternatives series(1, 3);
    EXPECT_FALSE(series.add("a"));
    EXPECT_FALSE(series.add("b"));
    EXPECT_EQ(series.add("b"), 1U);
    EXPECT_EQ(series.add("a"), 0U);
    EXPECT_EQ(series.made(), 2U);
    EXPECT_EQ(series.candidates(), 4U);
    EXPECT_FALSE(series.is_complete());
    EXPECT_FALSE(series.add("c"));
    EXPECT_TRUE(series.is_complete());
}

TEST(Alternatives, EndsAfterEightInARowThatBroughtNothing) {
    Alternatives series(1, 9);
    EXPECT_FALSE(series.add("a"));
    for (std::uint32_t i = 1; i < kFruitlessCandidatesMax; ++i) {
        EXPECT_TRUE(series.add_failure(ErrorCode::kGaveUp));
    }
    EXPECT_FALSE(series.add("b"));  // begins the count anew
    for (std::uint32_t i = 1; i < kFruitlessCandidatesMax; ++i) {
        EXPECT_TRUE(series.add("a"));
        EXPECT_FALSE(series.is_complete());
    }
    EXPECT_FALSE(series.add_failure(ErrorCode::kGaveUp));
    EXPECT_TRUE(series.is_complete());
}

TEST(Alternatives, AProofAStopAndAFaultEndTheSeries) {
    for (const ErrorCode code :
         {ErrorCode::kContradiction,
          ErrorCode::kCancelled,
          ErrorCode::kTooLarge,
          ErrorCode::kInternal}) {
        EXPECT_FALSE(Alternatives(1, 3).add_failure(code));
    }
}

}  // namespace
}  // namespace modelsynth
