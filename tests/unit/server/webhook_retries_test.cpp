// How long webhooks wait for their next try, and what receivers may ask for.

#include "server/webhooks/retry_after.h"
#include "server/webhooks/retry_pauses.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace modelsynth::server {

namespace {

using proto::UnixMillis;

constexpr double kNearlyOne = 0x1.fffffffffffffp-1;
constexpr UnixMillis kMinuteMs = 60'000;

// 1994-11-06T08:49:37Z, the date of RFC 9110's examples.
constexpr UnixMillis kDate = 784'111'777'000;

RetryPauses pauses_with(double fraction) {
    return {WebhookConfig{}, [fraction] { return fraction; }};
}

std::vector<UnixMillis> all_pauses(RetryPauses pauses, std::optional<UnixMillis> asked = {}) {
    std::vector<UnixMillis> all;
    for (std::uint32_t tries = 1; tries < WebhookConfig{}.tries_max; ++tries) {
        all.push_back(pauses.after(tries, asked));
    }
    return all;
}

using Pauses = std::vector<UnixMillis>;

}  // namespace

TEST(WebhookPauses, AreSixTimesAsLongEachTimeInTheMiddleOfTheirRange) {
    const Pauses nominal = {5'000, 30'000, 180'000, 1'080'000, 6'480'000};
    EXPECT_EQ(all_pauses(pauses_with(0.5)), nominal);
    EXPECT_EQ(pauses_with(0.5).longest(), nominal.back());
}

TEST(WebhookPauses, AreAFifthShorterOrLongerAtTheMost) {
    EXPECT_EQ(all_pauses(pauses_with(0)), (Pauses{4'000, 24'000, 144'000, 864'000, 5'184'000}));
    EXPECT_EQ(
        all_pauses(pauses_with(kNearlyOne)), (Pauses{6'000, 36'000, 216'000, 1'296'000, 7'776'000})
    );
}

TEST(WebhookPauses, EachIsDrawnAnew) {
    double next = 0;
    RetryPauses pauses(WebhookConfig{}, [&next] { return next += 0.125; });
    EXPECT_EQ(pauses.after(1), 4'250);
    EXPECT_EQ(pauses.after(1), 4'500);
    EXPECT_EQ(pauses.after(2, 0), 28'500);
}

TEST(WebhookPauses, WhatTheReceiverAsksForIsWaitedAndALittleMore) {
    EXPECT_EQ(pauses_with(0).after(1, 10 * kMinuteMs), 10 * kMinuteMs);
    EXPECT_EQ(pauses_with(0.5).after(1, 10 * kMinuteMs), 11 * kMinuteMs);
    EXPECT_EQ(pauses_with(kNearlyOne).after(1, 10 * kMinuteMs), 12 * kMinuteMs);
}

TEST(WebhookPauses, WhatTheReceiverAsksForMakesNoneShorter) {
    for (const double fraction : {0.0, 0.5, kNearlyOne}) {
        EXPECT_EQ(all_pauses(pauses_with(fraction), 0), all_pauses(pauses_with(fraction)));
        EXPECT_EQ(all_pauses(pauses_with(fraction), 1'000), all_pauses(pauses_with(fraction)));
    }
}

TEST(WebhookPauses, WhatTheReceiverAsksForIsNotWaitedLongerThanTheLongest) {
    const UnixMillis longest = pauses_with(0).longest();
    EXPECT_EQ(pauses_with(0).after(1, longest - 1), longest - 1);
    for (const UnixMillis asked :
         {longest, longest + 1, std::numeric_limits<UnixMillis>::max() / 1000 * 1000}) {
        EXPECT_EQ(all_pauses(pauses_with(0), asked), Pauses(5, longest));
        EXPECT_EQ(pauses_with(kNearlyOne).after(1, asked), longest);
    }
}

TEST(WebhookPauses, ThereIsALongestForWhoTriesOnceOrTwice) {
    WebhookConfig config;
    for (const std::uint32_t tries_max : {0U, 1U, 2U}) {
        config.tries_max = tries_max;
        EXPECT_EQ(RetryPauses(config, [] { return 0.5; }).longest(), 5'000);
    }
}

TEST(WebhookPauses, TheSourceOfRandomnessKeepsToItsRangeAndDiffersBetweenTwo) {
    std::set<double> seen;
    for (int source = 0; source < 2; ++source) {
        const auto random = random_fractions();
        for (int i = 0; i < 1000; ++i) {
            const double fraction = random();
            ASSERT_GE(fraction, 0);
            ASSERT_LT(fraction, 1);
            seen.insert(fraction);
        }
    }
    // Two of 2000 are the same once in billions of runs.
    EXPECT_EQ(seen.size(), 2000U);
}

TEST(RetryAfter, SecondsAreTaken) {
    EXPECT_EQ(parse_retry_after("0", kDate), 0);
    EXPECT_EQ(parse_retry_after("120", kDate), 120'000);
    EXPECT_EQ(parse_retry_after("0010", kDate), 10'000);
}

TEST(RetryAfter, SecondsThatNoNumberHoldsAreVeryMany) {
    const UnixMillis most = std::numeric_limits<UnixMillis>::max() / 1000 * 1000;
    for (const std::string& text :
         {std::string("9223372036854775"),
          std::string("9223372036854775807"),
          std::string("9223372036854775808"),
          std::string(4000, '9')}) {
        EXPECT_EQ(parse_retry_after(text, kDate), most) << text;
    }
    EXPECT_EQ(parse_retry_after("9223372036854774", kDate), 9'223'372'036'854'774'000);
}

TEST(RetryAfter, DatesAreTakenInAllFormsOfHttp) {
    for (const char* text :
         {"Sun, 06 Nov 1994 08:49:37 GMT",
          "Sunday, 06-Nov-94 08:49:37 GMT",
          "Sun Nov  6 08:49:37 1994"}) {
        EXPECT_EQ(parse_retry_after(text, kDate - 90'000), 90'000) << text;
        EXPECT_EQ(parse_retry_after(text, kDate - 500), 500) << text;
        EXPECT_EQ(parse_retry_after(text, kDate), 0) << text;
        EXPECT_EQ(parse_retry_after(text, kDate + 90'000), 0) << text;
    }
    EXPECT_GT(parse_retry_after("Fri, 31 Dec 9999 23:59:59 GMT", kDate), kDate);
}

TEST(RetryAfter, NothingElseIs) {
    for (const char* text :
         {"",
          " ",
          "-1",
          "+1",
          "1.5",
          "1e3",
          "0x10",
          "10 s",
          "soon",
          "120, 240",
          "Sun, 06 Nov 1994 08:49:37",
          "Sun, 06 Nov 1994 08:49:37 CET",
          "Sun, 06 Nov 1994 08:49:37 GMT+1",
          "Sun, 36 Nov 1994 08:49:37 GMT",
          "Sun, 06 Nov 1994 25:49:37 GMT",
          "Son, 06 Nov 1994 08:49:37 GMT",
          "1994-11-06T08:49:37Z"}) {
        EXPECT_FALSE(parse_retry_after(text, kDate)) << text;
    }
}

}  // namespace modelsynth::server
