// Who gets which job, and for how long.

#include "tests/unit/server/store_suite.h"

#include <algorithm>
#include <limits>
#include <mutex>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ClaimContract);

namespace {

NewJob job_at(std::string id, std::int32_t priority, proto::UnixMillis created) {
    NewJob job = new_job(std::move(id), priority);
    job.created = created;
    return job;
}

}  // namespace

TEST_P(ClaimContract, NothingIsClaimedWhenNothingIsQueued) { EXPECT_FALSE(claim()); }

TEST_P(ClaimContract, AClaimTellsWhatWasSubmitted) {
    NewJob job = new_job("a", 3);
    job.deadline_seconds = 12.5;
    job.seed = 0x8000'0000'0000'0001U;
    submit(job);
    between_steps();
    const auto claimed = claim(kNow + 7);
    ASSERT_TRUE(claimed);
    EXPECT_EQ(claimed->lease.job_id, "a");
    EXPECT_EQ(claimed->job.state, proto::JobState::kRunning);
    EXPECT_EQ(claimed->job.seed, job.seed);
    EXPECT_EQ(claimed->job.request, job.request);
    EXPECT_EQ(claimed->job.started, kNow + 7);
    EXPECT_EQ(claimed->deadline_seconds, 12.5);
    EXPECT_EQ(claimed->solved_seconds, 0);
    EXPECT_EQ(claimed->solver_version, "");
    EXPECT_EQ(claimed->version_base, 0U);
    EXPECT_EQ(claimed->head, 1U);
    EXPECT_EQ(claimed->fruitless_claims, 0U);
    EXPECT_FALSE(claimed->checkpoint);
    EXPECT_FALSE(claim());
}

TEST_P(ClaimContract, TheHighestPriorityGoesFirstAndEqualOnesInOrderOfArrival) {
    const std::vector<std::pair<std::string, std::int32_t>> jobs_in = {
        {"a", 0}, {"b", 5}, {"c", -5}, {"d", 5}, {"e", 0}, {"f", -5}};
    for (const auto& [id, priority] : jobs_in) {
        submit(new_job(id, priority));
    }
    between_steps();
    std::vector<std::string> order;
    while (const auto claimed = claim()) {
        order.push_back(claimed->lease.job_id);
    }
    EXPECT_EQ(order, (std::vector<std::string>{"b", "d", "a", "e", "c", "f"}));
}

TEST_P(ClaimContract, ExtremePrioritiesKeepTheirOrder) {
    constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
    submit(new_job("lowest", kMin));
    submit(new_job("zero", 0));
    submit(new_job("highest", kMax));
    submit(new_job("low", kMin + 1));
    submit(new_job("high", kMax - 1));
    between_steps();
    std::vector<std::string> order;
    while (const auto claimed = claim(kNow + 59'999)) {
        order.push_back(claimed->lease.job_id);
    }
    EXPECT_EQ(order, (std::vector<std::string>{"highest", "high", "zero", "low", "lowest"}));
}

TEST_P(ClaimContract, AJobThatWaitedThirtySecondsCountsOneLevelHigher) {
    struct Case {
        proto::UnixMillis later_by;  // how much later the job of higher priority came
        std::int32_t priority;       // of that one
        proto::UnixMillis now;       // after the first came
        bool first_wins;
    };

    const std::vector<Case> cases = {
        {0, 1, 0, false},
        {29'999, 1, 29'999, false},
        {30'000, 1, 30'000, true},  // equal: order of arrival
        {30'000, 1, 59'999, true},
        {30'000, 1, 60'000, true},  // both gained a level
        {15'000, 1, 29'999, false},
        {15'000, 1, 30'000, true},
        {15'000, 1, 45'000, false},
        {100, 3, 89'999, false},
        {100, 3, 90'000, false},  // the other gained its levels too, but the last
        {89'999, 3, 89'999, false},
        {90'000, 3, 90'000, true},
    };
    int number = 0;
    for (const Case& test : cases) {
        SCOPED_TRACE(number);
        const std::string name = std::to_string(number++);
        // An owner of its own, of whom nothing was handed out before.
        NewJob first = job_at("first" + name, 0, kNow);
        NewJob second = job_at("second" + name, test.priority, kNow + test.later_by);
        first.owner = second.owner = name;
        submit(first);
        submit(second);
        between_steps();
        const auto one = claim(kNow + test.now);
        const auto two = claim(kNow + test.now);
        ASSERT_TRUE(one && two);
        EXPECT_EQ(one->lease.job_id.starts_with("first"), test.first_wins);
        value(jobs().finish(one->lease, failed()));
        value(jobs().finish(two->lease, failed()));
    }
}

TEST_P(ClaimContract, AClockThatIsSetBackLetsNoneOfAnOwnerGoFirst) {
    submit(job_at("a", 0, kNow + 3'600'000));
    submit(job_at("b", 0, kNow));
    between_steps();
    EXPECT_EQ(claim(kNow + 40'000)->lease.job_id, "a");
    EXPECT_EQ(claim(kNow + 80'000)->lease.job_id, "b");
}

TEST_P(ClaimContract, OwnersTakeTurnsWhateverEachHasWaiting) {
    for (int i = 0; i < 50; ++i) {
        NewJob job = new_job("flood" + std::to_string(i));
        job.owner = "a";
        submit(job);
    }
    between_steps();
    std::vector<std::string> order;
    for (int i = 0; i < 6; ++i) {
        if (i == 3) {
            // Comes when all the others have waited for long.
            NewJob late = job_at("late", 0, kNow + 600'000);
            late.owner = "b";
            EXPECT_EQ(submit(late).job.queue_position, 0U);
        }
        order.push_back(claim(kNow + 600'000)->lease.job_id);
    }
    EXPECT_EQ(
        order, (std::vector<std::string>{"flood0", "flood1", "flood2", "late", "flood3", "flood4"})
    );
}

TEST_P(ClaimContract, OwnersShareByWhatTheirJobsCost) {
    for (int i = 0; i < 40; ++i) {
        NewJob job = new_job((i < 20 ? "dear" : "cheap") + std::to_string(i));
        job.owner = i < 20 ? "a" : "b";
        job.cost = i < 20 ? 300 : 100;
        submit(job);
    }
    between_steps();
    std::size_t cheap_count = 0;
    for (int i = 0; i < 24; ++i) {
        cheap_count += claim()->lease.job_id.starts_with("cheap") ? 1U : 0U;
    }
    // Three for one.
    EXPECT_EQ(cheap_count, 18U);
}

TEST_P(ClaimContract, WhoAsksForNothingIsOwedNothing) {
    const auto give = [this](const std::string& id, const std::string& owner) {
        NewJob job = new_job(id);
        job.owner = owner;
        submit(job);
    };
    give("first", "idle");
    EXPECT_EQ(claim()->lease.job_id, "first");
    for (int i = 0; i < 20; ++i) {
        give("busy" + std::to_string(i), "busy");
    }
    between_steps();
    for (int i = 0; i < 10; ++i) {
        claim();
    }
    give("back0", "idle");
    give("back1", "idle");
    give("back2", "idle");
    std::vector<std::string> order;
    for (int i = 0; i < 4; ++i) {
        order.push_back(claim()->lease.job_id.substr(0, 4));
    }
    EXPECT_EQ(std::count(order.begin(), order.end(), "back"), 2);
}

TEST_P(ClaimContract, WhatCostsTooMuchIsPassedBy) {
    NewJob dear = new_job("dear", 5);
    dear.cost = 101;
    submit(dear);
    NewJob cheap = new_job("cheap");
    cheap.cost = 100;
    submit(cheap);
    between_steps();
    ClaimLimits limits;
    limits.cost_max = 100;
    EXPECT_EQ(value(jobs().claim(kNow + 60'000, limits))->lease.job_id, "cheap");
    limits.cost_max = 101;
    EXPECT_EQ(value(jobs().claim(kNow + 60'000, limits))->lease.job_id, "dear");
}

TEST_P(ClaimContract, WhatDoesNotFitIsPassedByForAWhileAndThenWaitedFor) {
    NewJob large = job_at("large", 5, kNow);
    large.memory_bytes = 1000;
    submit(large);
    submit(job_at("small0", 0, kNow));
    submit(job_at("small1", 0, kNow));
    between_steps();
    ClaimLimits limits;
    limits.memory_bytes_max = 999;
    EXPECT_EQ(value(jobs().claim(kNow + 29'999, limits))->lease.job_id, "small0");
    EXPECT_FALSE(value(jobs().claim(kNow + 30'000, limits)));
    limits.memory_bytes_max = 1000;
    EXPECT_EQ(value(jobs().claim(kNow + 30'000, limits))->lease.job_id, "large");
    EXPECT_EQ(value(jobs().claim(kNow + 30'000, limits))->lease.job_id, "small1");
}

TEST_P(ClaimContract, ClaimersGetEachJobOnce) {
    constexpr std::size_t kClaimers = 8;
    constexpr std::size_t kJobs = 100;
    run_together(kClaimers, [this](std::size_t thread) {
        for (std::size_t i = thread; i < kJobs; i += kClaimers) {
            value(jobs().submit(
                new_job("job" + std::to_string(i), static_cast<std::int32_t>(i % 3)), kNoLimit
            ));
        }
    });
    std::mutex mutex;
    std::vector<std::string> handed_out;
    run_together(kClaimers, [&](std::size_t) {
        while (const auto claimed = value(jobs().claim(kNow, {}))) {
            if (!is_own(claimed->lease.job_id)) {
                value(jobs().release(claimed->lease, 0));
                return;
            }
            const std::lock_guard lock(mutex);
            handed_out.push_back(claimed->lease.job_id);
        }
    });
    std::sort(handed_out.begin(), handed_out.end());
    EXPECT_EQ(handed_out.size(), kJobs);
    EXPECT_EQ(std::unique(handed_out.begin(), handed_out.end()), handed_out.end());
}

TEST_P(ClaimContract, TheTokenGrowsWithEveryClaim) {
    submit(new_job("a"));
    std::uint64_t last = 0;
    for (int i = 0; i < 4; ++i) {
        const auto claimed = claim();
        ASSERT_TRUE(claimed);
        EXPECT_GT(claimed->lease.token, last);
        last = claimed->lease.token;
        if (i % 2 == 0) {
            value(jobs().release(claimed->lease, 0));
            between_steps();
        } else {
            reopen();
        }
    }
}

TEST_P(ClaimContract, AnOldLeaseChangesNothing) {
    const Claim old = submit_and_claim("a");
    value(jobs().release(old.lease, 1));
    // While the job is queued, and while another holds it.
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(
            error_of(append(jobs(), old.lease, {block_event(0)})), StoreErrorCode::kLeaseLost
        );
        EXPECT_EQ(error_of(jobs().finish(old.lease, succeeded())), StoreErrorCode::kLeaseLost);
        EXPECT_EQ(error_of(jobs().release(old.lease, 9)), StoreErrorCode::kLeaseLost);
        if (round == 0) {
            between_steps();
            const auto current = claim();
            ASSERT_TRUE(current);
            EXPECT_EQ(current->solved_seconds, 1);
        }
    }
    EXPECT_EQ(log("a").size(), 1U);
}

TEST_P(ClaimContract, TheLeaseOfBeforeARestartIsLost) {
    const Claim old = submit_and_claim("a");
    reopen();
    EXPECT_EQ(find("a").state, proto::JobState::kQueued);
    EXPECT_EQ(error_of(jobs().finish(old.lease, succeeded())), StoreErrorCode::kLeaseLost);
    const auto current = claim();
    ASSERT_TRUE(current);
    EXPECT_EQ(error_of(jobs().finish(old.lease, succeeded())), StoreErrorCode::kLeaseLost);
    EXPECT_EQ(value(jobs().finish(current->lease, succeeded())).state, proto::JobState::kSucceeded);
    EXPECT_EQ(
        error_of(append(jobs(), current->lease, {block_event(0)})), StoreErrorCode::kLeaseLost
    );
}

TEST_P(ClaimContract, ALeaseOfAnInventedJobOrTokenIsLost) {
    const Claim claimed = submit_and_claim("a");
    for (const Lease& lease :
         {Lease{"none", 1}, Lease{"a", claimed.lease.token + 1}, Lease{"a", 0}}) {
        EXPECT_EQ(error_of(append(jobs(), lease, {block_event(0)})), StoreErrorCode::kLeaseLost);
        EXPECT_EQ(error_of(jobs().finish(lease, succeeded())), StoreErrorCode::kLeaseLost);
        EXPECT_EQ(error_of(jobs().release(lease, 0)), StoreErrorCode::kLeaseLost);
    }
    EXPECT_EQ(find("a").state, proto::JobState::kRunning);
}

TEST_P(ClaimContract, ReleaseGivesTheJobBackAtItsOldPlace) {
    submit(new_job("a"));
    submit(new_job("b"));
    const auto claimed = claim(kNow + 1);
    ASSERT_TRUE(claimed);
    value(jobs().release(claimed->lease, 2.5));
    between_steps();
    EXPECT_EQ(find("a").state, proto::JobState::kQueued);
    const auto again = claim(kNow + 8);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->lease.job_id, "a");
    EXPECT_EQ(again->solved_seconds, 2.5);
    EXPECT_EQ(again->job.started, kNow + 1);
    EXPECT_EQ(again->fruitless_claims, 0U);
    EXPECT_EQ(log("a").size(), 1U);
}

TEST_P(ClaimContract, ReleaseKeepsTheCountOfFruitlessClaims) {
    submit(new_job("a"));
    for (std::uint32_t crashes = 0; crashes < 3; ++crashes) {
        const auto released = claim();
        ASSERT_TRUE(released);
        EXPECT_EQ(released->fruitless_claims, crashes);
        value(jobs().release(released->lease, 0));
        const auto crashed = claim();
        ASSERT_TRUE(crashed);
        EXPECT_EQ(crashed->fruitless_claims, crashes);
        // What is no block is no progress.
        value(append(jobs(), crashed->lease, {{"started", "{}", kNow}}, progress_of(0)));
        reopen();
    }
}

TEST_P(ClaimContract, ABlockBeginsTheCountOfFruitlessClaimsAnew) {
    submit(new_job("a"));
    for (int crash = 0; crash < 3; ++crash) {
        ASSERT_TRUE(claim());
        reopen();
    }
    const auto fruitful = claim();
    ASSERT_TRUE(fruitful);
    EXPECT_EQ(fruitful->fruitless_claims, 3U);
    value(append(jobs(), fruitful->lease, {block_event(0)}));
    value(jobs().release(fruitful->lease, 0));
    between_steps();
    EXPECT_EQ(claim()->fruitless_claims, 0U);
}

TEST_P(ClaimContract, AClaimTellsWhatEarlierOnesDid) {
    const Claim first = submit_and_claim("a");
    Progress progress = progress_of(2);
    progress.solved_seconds = 1.5;
    value(append(jobs(), first.lease, {block_event(0), block_event(1)}, progress));
    reopen();
    const auto second = claim();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->job.blocks_done, 2U);
    EXPECT_EQ(second->solver_version, "v1");
    EXPECT_EQ(second->version_base, 1U);
    EXPECT_EQ(second->solved_seconds, 1.5);
    EXPECT_EQ(second->head, 3U);
    EXPECT_EQ(second->job.head, 3U);
    EXPECT_EQ(second->job.blocks_total, 100U);
}

TEST_P(ClaimContract, FinishWritesTheStateTheLastEventAndTheLinks) {
    const auto pin = value(artifacts().put("glb"));
    const Claim claimed = submit_and_claim("a");
    value(append(jobs(), claimed.lease, {block_event(0)}));
    const Outcome outcome = succeeded({{"nodes.glb", pin->digest()}});
    const proto::Job ended = value(jobs().finish(claimed.lease, outcome));
    EXPECT_EQ(ended.state, proto::JobState::kSucceeded);
    EXPECT_EQ(ended.result, outcome.result);
    EXPECT_EQ(ended.finished, outcome.finished);
    EXPECT_EQ(ended.head, 3U);
    EXPECT_EQ(value(jobs().artifact("a", "nodes.glb")), pin->digest());
    EXPECT_EQ(
        tuple_of(log("a").back()),
        EventTuple(3, "succeeded", proto::succeeded_fields(outcome.result), outcome.finished)
    );
    EXPECT_FALSE(claim());
}

TEST_P(ClaimContract, FinishRepeatedGivesTheSameAnswer) {
    const Claim claimed = submit_and_claim("a");
    const proto::Job first = value(jobs().finish(claimed.lease, failed()));
    between_steps();
    for (const Outcome& outcome : {failed(), succeeded()}) {
        const proto::Job again = value(jobs().finish(claimed.lease, outcome));
        EXPECT_EQ(proto::to_json(again), proto::to_json(first));
        EXPECT_EQ(again.head, first.head);
    }
    EXPECT_EQ(log("a").size(), 2U);
}

TEST_P(ClaimContract, FinishWithADigestThatIsNotStoredIsAConflictAndLeavesTheJobRunning) {
    const auto pin = value(artifacts().put("stored"));
    const Claim claimed = submit_and_claim("a");
    for (const std::string& digest :
         {sha256_hex("never stored"),
          std::string(),
          std::string("ab"),
          std::string("not hexadecimal")}) {
        EXPECT_EQ(
            error_of(
                jobs().finish(claimed.lease, succeeded({{"good", pin->digest()}, {"bad", digest}}))
            ),
            StoreErrorCode::kConflict
        ) << digest;
    }
    EXPECT_EQ(find("a").state, proto::JobState::kRunning);
    EXPECT_EQ(error_of(jobs().artifact("a", "good")), StoreErrorCode::kNotFound);
    EXPECT_EQ(log("a").size(), 1U);
    EXPECT_EQ(
        value(jobs().finish(claimed.lease, succeeded({{"good", pin->digest()}}))).state,
        proto::JobState::kSucceeded
    );
}

}  // namespace modelsynth::server
