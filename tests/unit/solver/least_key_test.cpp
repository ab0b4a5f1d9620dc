#include "solver/core/least_key.h"

#include "solver/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace modelsynth {
namespace {

TEST(LeastKey, HasNoneAtFirst) {
    EXPECT_EQ(LeastKey(0).least(), LeastKey::kNoKey);
    EXPECT_EQ(LeastKey(5).least(), LeastKey::kNoKey);
}

TEST(LeastKey, FindsTheFirstPlaceOfTheLeastKey) {
    RandomStream random({1, 0, 0, 44});
    for (const std::uint32_t places : {1U, 2U, 3U, 16U, 37U}) {
        SCOPED_TRACE(std::to_string(places) + " places");
        LeastKey keys(places);
        std::vector<std::uint64_t> expected(places, LeastKey::kNoKey);
        for (int step = 0; step < 2000; ++step) {
            // Few keys, so that many are equal; some go.
            const std::uint64_t key = random.below(10);
            const std::size_t place = random.below(places);
            expected[place] = key < 8 ? key : LeastKey::kNoKey;
            keys.set(place, expected[place]);
            const auto least = std::min_element(expected.begin(), expected.end());
            ASSERT_EQ(keys.least(), *least);
            if (*least != LeastKey::kNoKey) {
                ASSERT_EQ(keys.first_least(), static_cast<std::size_t>(least - expected.begin()));
            }
        }
    }
}

}  // namespace
}  // namespace modelsynth
