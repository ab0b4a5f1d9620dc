#include "server/jobs/drain_rate.h"

#include <gtest/gtest.h>

#include <chrono>

namespace modelsynth::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr DrainRate::Clock::time_point kBegun{seconds(1000)};

TEST(DrainRate, GrowsWhileNothingEndsUpToAMinute) {
    const DrainRate rate(kBegun);
    EXPECT_EQ(rate.seconds_to_next(kBegun), 1U);
    EXPECT_EQ(rate.seconds_to_next(kBegun + milliseconds(7100)), 8U);
    EXPECT_EQ(rate.seconds_to_next(kBegun + seconds(10000)), 60U);
}

TEST(DrainRate, IsTheMeanOfTheLastPauses) {
    DrainRate rate(kBegun);
    for (int i = 1; i <= 40; ++i) {
        rate.on_let_go(kBegun + seconds(i));
    }
    // The pause that is not over counts: sixteen in 80 s.
    EXPECT_EQ(rate.seconds_to_next(kBegun + seconds(25 + 80)), 5U);
    for (int i = 0; i < 16; ++i) {
        rate.on_let_go(kBegun + seconds(105));
    }
    EXPECT_EQ(rate.seconds_to_next(kBegun + seconds(106)), 1U);
}

}  // namespace
}  // namespace modelsynth::server
