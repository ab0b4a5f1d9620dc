// What clients ask of a store: jobs in, jobs out.

#include "tests/unit/server/store_suite.h"

#include <algorithm>
#include <atomic>
#include <limits>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(JobContract);

TEST_P(JobContract, SubmitMakesTheJobItsKeyAndItsFirstEventTogether) {
    NewJob job = keyed_job("a", "key", "hash");
    job.seed = std::numeric_limits<std::uint64_t>::max();
    const Submitted submitted = submit(job);
    EXPECT_FALSE(submitted.replayed);
    EXPECT_EQ(submitted.job.id, "a");
    EXPECT_EQ(submitted.job.queue_position, 0U);
    between_steps();
    const proto::Job found = find("a");
    EXPECT_EQ(found.state, proto::JobState::kQueued);
    EXPECT_EQ(found.solver, job.solver);
    EXPECT_EQ(found.seed, job.seed);
    EXPECT_EQ(found.request, job.request);
    EXPECT_EQ(found.created, kNow);
    EXPECT_EQ(found.head, 1U);
    EXPECT_FALSE(found.started || found.finished || found.expires);
    EXPECT_EQ(value(jobs().find_key("", "key", "hash"))->id, "a");
    EXPECT_EQ(
        tuples_of(log("a")), (std::vector<EventTuple>{{1, "queued", R"({"position":0})", kNow}})
    );
}

TEST_P(JobContract, AnUnknownJobIsNotFound) {
    EXPECT_EQ(error_of(jobs().find("none")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(jobs().cancel("none", kNow)), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(jobs().erase("none")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(jobs().artifact("none", "labels")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(events().read("none", 0, 10)), StoreErrorCode::kNotFound);
    EXPECT_FALSE(value(jobs().checkpoint("none")));
    EXPECT_FALSE(value(jobs().find_key("", "none", "hash")));
}

TEST_P(JobContract, AKnownKeyWithTheSameHashAnswersWithItsJob) {
    submit(keyed_job("a", "key", "hash"));
    between_steps();
    const Submitted again = submit(keyed_job("b", "key", "hash"));
    EXPECT_TRUE(again.replayed);
    EXPECT_EQ(again.job.id, "a");
    EXPECT_EQ(error_of(jobs().find("b")), StoreErrorCode::kNotFound);
    EXPECT_EQ(log("a").size(), 1U);
}

TEST_P(JobContract, AKnownKeyWithAnotherHashIsAConflict) {
    submit(keyed_job("a", "key", "hash"));
    between_steps();
    const NewJob other = keyed_job("b", "key", "another hash");
    EXPECT_EQ(error_of(jobs().submit(other, kNoLimit)), StoreErrorCode::kConflict);
    EXPECT_EQ(error_of(jobs().find_key("", "key", "another hash")), StoreErrorCode::kConflict);
    EXPECT_EQ(listed(), std::vector<std::string>{"a"});
}

TEST_P(JobContract, AJobThatNeedsWhatIsNotStoredIsNotThere) {
    {
        const auto pin = value(artifacts().put("stored"));
        NewJob job = keyed_job("a", "key", "hash");
        job.artifacts = {{"one", pin->digest()}, {"two", sha256_hex("never stored")}};
        EXPECT_EQ(error_of(jobs().submit(job, kNoLimit)), StoreErrorCode::kConflict);
    }
    between_steps();
    EXPECT_EQ(error_of(jobs().find("a")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(jobs().artifact("a", "one")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(events().read("a", 0, 10)), StoreErrorCode::kNotFound);
    EXPECT_FALSE(value(jobs().find_key("", "key", "hash")));
}

TEST_P(JobContract, AKnownKeyAnswersWhateverTheJobWouldNeed) {
    submit(keyed_job("a", "key", "hash"));
    between_steps();
    NewJob again = keyed_job("b", "key", "hash");
    again.artifacts = {{"origin", sha256_hex("gone by now")}};
    EXPECT_EQ(submit(again).job.id, "a");
    EXPECT_EQ(error_of(jobs().artifact("a", "origin")), StoreErrorCode::kNotFound);
}

TEST_P(JobContract, AKeyIsKnownAfterTheJobHasEnded) {
    submit(keyed_job("a", "key", "hash"));
    value(jobs().cancel("a", kNow));
    between_steps();
    const Submitted again = submit(keyed_job("b", "key", "hash"));
    EXPECT_TRUE(again.replayed);
    EXPECT_EQ(again.job.state, proto::JobState::kCancelled);
}

TEST_P(JobContract, JobsWithoutAKeyAreAllNew) {
    submit(new_job("a"));
    EXPECT_FALSE(submit(new_job("b")).replayed);
    EXPECT_EQ(listed(), (std::vector<std::string>{"b", "a"}));
}

TEST_P(JobContract, KeysThatDifferAfterANulByteAreDifferent) {
    const std::string one("key\0one", 7);
    const std::string two("key\0two", 7);
    submit(keyed_job("a", one, "hash"));
    between_steps();
    EXPECT_FALSE(submit(keyed_job("b", two, "hash")).replayed);
    EXPECT_EQ(value(jobs().find_key("", one, "hash"))->id, "a");
    EXPECT_EQ(value(jobs().find_key("", two, "hash"))->id, "b");
    EXPECT_FALSE(value(jobs().find_key("", "key", "hash")));
}

TEST_P(JobContract, AFullQueueTakesNoJobButAnswersForAKnownKey) {
    const std::size_t before = value(jobs().queued_count());
    submit(keyed_job("a", "key", "hash"));
    submit(new_job("b"));
    between_steps();
    EXPECT_EQ(value(jobs().queued_count()), before + 2);
    const QueueLimits full = {before + 2};
    EXPECT_EQ(error_of(jobs().submit(new_job("c"), full)), StoreErrorCode::kQueueFull);
    EXPECT_TRUE(value(jobs().submit(keyed_job("d", "key", "hash"), full)).replayed);
    EXPECT_EQ(listed(), (std::vector<std::string>{"b", "a"}));
    // A running job is not in the queue.
    ASSERT_TRUE(claim());
    EXPECT_FALSE(value(jobs().submit(new_job("c"), full)).replayed);
}

TEST_P(JobContract, AnOwnerHasSoManyUnfinishedJobsAndNoMore) {
    const auto give = [this](const std::string& id, const std::string& owner) {
        NewJob job = new_job(id);
        job.owner = owner;
        return error_of(jobs().submit(job, {1'000'000, 2}));
    };
    EXPECT_FALSE(give("a1", "a"));
    const auto running = claim();
    ASSERT_TRUE(running);
    EXPECT_FALSE(give("a2", "a"));
    between_steps();
    EXPECT_EQ(give("a3", "a"), StoreErrorCode::kOwnerFull);
    EXPECT_FALSE(give("b1", "b"));
    value(jobs().cancel("a2", kNow));
    EXPECT_FALSE(give("a3", "a"));
}

TEST_P(JobContract, AKeyIsItsOwnersAlone) {
    for (const char* owner : {"a", "b"}) {
        NewJob job = keyed_job(std::string("job of ") + owner, "key", "hash");
        job.owner = owner;
        EXPECT_FALSE(submit(job).replayed);
    }
    between_steps();
    EXPECT_EQ(value(jobs().find_key("a", "key", "hash"))->id, "job of a");
    EXPECT_EQ(value(jobs().find_key("b", "key", "hash"))->id, "job of b");
    EXPECT_FALSE(value(jobs().find_key("", "key", "hash")));
}

TEST_P(JobContract, AListIsOfOneOwnerOrOfAll) {
    for (int i = 0; i < 5; ++i) {
        NewJob job = new_job("job" + std::to_string(i));
        job.owner = i % 2 == 0 ? "even" : "odd";
        submit(job);
    }
    between_steps();
    JobQuery query{"even", std::nullopt, 2, ""};
    const JobPage first = value(jobs().list(query));
    ASSERT_TRUE(first.next);
    query.cursor = *first.next;
    const JobPage second = value(jobs().list(query));
    EXPECT_FALSE(second.next);
    ASSERT_EQ(first.jobs.size(), 2U);
    ASSERT_EQ(second.jobs.size(), 1U);
    EXPECT_EQ(first.jobs[0].id, "job4");
    EXPECT_EQ(second.jobs[0].id, "job0");
    EXPECT_EQ(second.jobs[0].owner, "even");
}

TEST_P(JobContract, FiftyThreadsWithOneKeyMakeOneJob) {
    std::atomic<int> made = 0;
    std::vector<std::string> answers(50);
    run_together(answers.size(), [&](std::size_t i) {
        const auto answer = jobs().submit(keyed_job("job" + std::to_string(i), "key", "h"), {500});
        if (answer) {
            answers[i] = answer->job.id;
            made += answer->replayed ? 0 : 1;
        }
    });
    between_steps();
    EXPECT_EQ(made, 1);
    const std::vector<std::string> ids = listed();
    ASSERT_EQ(ids.size(), 1U);
    EXPECT_EQ(answers, std::vector<std::string>(50, ids.front()));
    EXPECT_EQ(log(ids.front()).size(), 1U);
}

TEST_P(JobContract, PositionsInTheQueueFollowPriorityAndArrival) {
    EXPECT_EQ(submit(new_job("a", 1)).job.queue_position, 0U);
    EXPECT_EQ(submit(new_job("b", 1)).job.queue_position, 1U);
    EXPECT_EQ(submit(new_job("c", 5)).job.queue_position, 0U);
    EXPECT_EQ(submit(new_job("d", 0)).job.queue_position, 3U);
    between_steps();
    EXPECT_EQ(find("a").queue_position, 1U);
    EXPECT_EQ(find("d").queue_position, 3U);
    const auto running = claim();
    ASSERT_TRUE(running);
    EXPECT_FALSE(find("c").queue_position);
    EXPECT_EQ(find("a").queue_position, 0U);
}

TEST_P(JobContract, PagesGoFromTheNewestToTheOldest) {
    std::vector<std::string> expected;
    for (int i = 0; i < 10; ++i) {
        expected.push_back("job" + std::to_string(i));
        submit(new_job(expected.back()));
    }
    std::reverse(expected.begin(), expected.end());
    between_steps();
    for (const std::size_t limit : {1U, 3U, 5U, 9U, 10U, 11U, 1000U}) {
        EXPECT_EQ(listed(std::nullopt, limit), expected) << limit;
    }
}

TEST_P(JobContract, PagesOfOneStateHoldNoOther) {
    for (const char* id : {"a", "b", "c", "d", "e"}) {
        submit(new_job(id));
    }
    value(jobs().cancel("b", kNow));
    value(jobs().cancel("d", kNow));
    between_steps();
    EXPECT_EQ(listed(proto::JobState::kQueued, 2), (std::vector<std::string>{"e", "c", "a"}));
    EXPECT_EQ(listed(proto::JobState::kCancelled, 1), (std::vector<std::string>{"d", "b"}));
    EXPECT_EQ(listed(proto::JobState::kFailed), std::vector<std::string>());
}

TEST_P(JobContract, PagesStayRightWhileJobsComeAndGo) {
    for (int i = 0; i < 12; ++i) {
        submit(new_job("old" + std::to_string(i)));
    }
    std::vector<std::string> seen;
    JobQuery query{{}, std::nullopt, 3, ""};
    for (int page_index = 0;; ++page_index) {
        const JobPage page = value(jobs().list(query));
        for (const proto::Job& job : page.jobs) {
            seen.push_back(job.id);
        }
        if (!page.next || seen.size() >= 12 || !is_own(seen.back())) {
            break;
        }
        query.cursor = *page.next;
        submit(new_job("new" + std::to_string(page_index)));
        if (page_index == 0) {
            value(jobs().erase("old9"));  // the one that the cursor names
            value(jobs().erase("old5"));  // one that is still to come
            value(jobs().erase("old10"));
        }
        between_steps();
    }
    std::erase_if(seen, [this](const std::string& id) { return !is_own(id); });
    EXPECT_EQ(
        seen,
        (std::vector<std::string>{
            "old11",
            "old10",
            "old9",
            "old8",
            "old7",
            "old6",
            "old4",
            "old3",
            "old2",
            "old1",
            "old0"})
    );
}

TEST_P(JobContract, ACursorThatWasNotGivenOutIsInvalid) {
    submit(new_job("a"));
    for (const std::string cursor :
         {"!",
          "-1",
          "0",
          "1",
          "zzz",
          " 1",
          "1 ",
          "1.5",
          "10000",
          "zzzzzzzzzzzzzzzzzzzzzzzz",
          "\xc3\xbc"}) {
        JobQuery query;
        query.cursor = cursor;
        EXPECT_EQ(error_of(jobs().list(query)), StoreErrorCode::kInvalid) << cursor;
    }
    JobQuery query;
    query.cursor = std::string("1\0", 2);
    EXPECT_EQ(error_of(jobs().list(query)), StoreErrorCode::kInvalid);
}

TEST_P(JobContract, AQueuedJobThatIsCancelledEndsAtOnce) {
    submit(new_job("a"));
    between_steps();
    const proto::Job cancelled = value(jobs().cancel("a", kNow + 5));
    EXPECT_EQ(cancelled.state, proto::JobState::kCancelled);
    EXPECT_EQ(cancelled.finished, kNow + 5);
    EXPECT_EQ(cancelled.expires, kNow + 5 + kRetentionMs);
    between_steps();
    EXPECT_FALSE(claim());
    const std::vector<Event> events_of_a = log("a");
    ASSERT_EQ(events_of_a.size(), 2U);
    EXPECT_EQ(tuple_of(events_of_a.back()), EventTuple(2, "cancelled", "{}", kNow + 5));
    EXPECT_TRUE(value(events().read("a", 2, 10)).ended);
}

TEST_P(JobContract, CancellingAnEndedJobChangesNothing) {
    submit(new_job("a"));
    value(jobs().cancel("a", kNow + 5));
    between_steps();
    EXPECT_EQ(value(jobs().cancel("a", kNow + 9)).finished, kNow + 5);
    const Claim claimed = submit_and_claim("b");
    value(jobs().finish(claimed.lease, succeeded()));
    between_steps();
    EXPECT_EQ(value(jobs().cancel("b", kNow + 9)).state, proto::JobState::kSucceeded);
    EXPECT_EQ(log("a").size(), 2U);
    EXPECT_EQ(log("b").size(), 2U);
}

TEST_P(JobContract, ARunningJobThatIsCancelledIsEndedByItsHolder) {
    const Claim claimed = submit_and_claim("a");
    EXPECT_EQ(value(jobs().cancel("a", kNow + 5)).state, proto::JobState::kRunning);
    EXPECT_EQ(value(jobs().cancel("a", kNow + 6)).state, proto::JobState::kRunning);
    EXPECT_EQ(log("a").size(), 1U);
    value(append(jobs(), claimed.lease, {block_event(0)}));
    // Whatever the outcome says.
    const proto::Job ended = value(jobs().finish(claimed.lease, succeeded()));
    EXPECT_EQ(ended.state, proto::JobState::kCancelled);
    EXPECT_EQ(ended.result, "");
    between_steps();
    EXPECT_EQ(find("a").state, proto::JobState::kCancelled);
    EXPECT_EQ(log("a").back().type, "cancelled");
}

TEST_P(JobContract, ACancelledJobIsNotQueuedAgainByARestart) {
    submit_and_claim("a");
    value(jobs().cancel("a", kNow));
    reopen();
    EXPECT_EQ(find("a").state, proto::JobState::kCancelled);
    EXPECT_EQ(log("a").back().type, "cancelled");
    EXPECT_TRUE(find("a").expires);
}

TEST_P(JobContract, ACancelledJobIsNotQueuedAgainByItsRelease) {
    const Claim claimed = submit_and_claim("a");
    value(jobs().cancel("a", kNow));
    value(jobs().release(claimed.lease, 1));
    between_steps();
    EXPECT_FALSE(claim());
    EXPECT_EQ(find("a").state, proto::JobState::kCancelled);
    EXPECT_EQ(log("a").back().type, "cancelled");
}

TEST_P(JobContract, CancelAndFinishAtTheSameTimeMakeOneTerminalEvent) {
    constexpr std::size_t kRaces = 200;
    constexpr std::size_t kPairs = 8;
    std::vector<Lease> leases(kRaces);
    run_together(kPairs, [&](std::size_t thread) {
        for (std::size_t i = thread; i < kRaces; i += kPairs) {
            value(jobs().submit(new_job("job" + std::to_string(i)), kNoLimit));
        }
    });
    run_together(kPairs, [&](std::size_t thread) {
        for (std::size_t i = thread; i < kRaces; i += kPairs) {
            leases[i] = value(jobs().claim(kNow, {}))->lease;
        }
    });
    std::atomic<int> finished_well = 0;
    run_together(2 * kPairs, [&](std::size_t thread) {
        for (std::size_t i = thread / 2; i < kRaces; i += kPairs) {
            if (thread % 2 == 0) {
                value(jobs().cancel(leases[i].job_id, kNow + 3));
            } else {
                const proto::Job job = value(jobs().finish(leases[i], succeeded()));
                finished_well += job.state == proto::JobState::kSucceeded ? 1 : 0;
            }
        }
    });
    between_steps();
    EXPECT_EQ(listed(proto::JobState::kSucceeded).size(), static_cast<std::size_t>(finished_well));
    for (const Lease& lease : leases) {
        const proto::Job job = find(lease.job_id);
        EXPECT_TRUE(proto::is_ended(job.state)) << job.id;
        const std::vector<Event> events_of_job = log(job.id);
        ASSERT_EQ(events_of_job.size(), 2U) << job.id;
        EXPECT_EQ(events_of_job.back().type, proto::state_name(job.state)) << job.id;
    }
}

TEST_P(JobContract, CancelAndClaimAtTheSameTimeLeaveNoJobThatRunsOn) {
    constexpr std::size_t kRaces = 40;
    for (std::size_t i = 0; i < kRaces; ++i) {
        submit(new_job("job" + std::to_string(i)));
    }
    run_together(8, [&](std::size_t thread) {
        for (std::size_t i = thread / 2; i < kRaces; i += 4) {
            if (thread % 2 == 0) {
                value(jobs().cancel("job" + std::to_string(i), kNow + 3));
            } else if (const auto claimed = value(jobs().claim(kNow, {}));
                       claimed && is_own(claimed->lease.job_id)) {
                value(jobs().finish(claimed->lease, failed()));
            } else if (claimed) {
                value(jobs().release(claimed->lease, 0));
            }
        }
    });
    between_steps();
    EXPECT_FALSE(claim());
    for (std::size_t i = 0; i < kRaces; ++i) {
        const proto::Job job = find("job" + std::to_string(i));
        EXPECT_TRUE(proto::is_ended(job.state)) << job.id;
        EXPECT_EQ(log(job.id).size(), 2U) << job.id;
    }
}

TEST_P(JobContract, AnErasedJobIsForgottenWithItsKey) {
    submit(keyed_job("a", "key", "hash"));
    submit(new_job("b"));
    between_steps();
    value(jobs().erase("a"));
    between_steps();
    EXPECT_EQ(error_of(jobs().find("a")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(jobs().erase("a")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(events().read("a", 0, 10)), StoreErrorCode::kNotFound);
    EXPECT_EQ(listed(), std::vector<std::string>{"b"});
    EXPECT_FALSE(value(jobs().find_key("", "key", "hash")));
    EXPECT_FALSE(submit(keyed_job("a", "key", "another hash")).replayed);
    EXPECT_EQ(log("a").size(), 1U);
}

TEST_P(JobContract, TheHolderOfAnErasedJobHasLostIt) {
    const Claim claimed = submit_and_claim("a");
    value(jobs().erase("a"));
    EXPECT_EQ(
        error_of(append(jobs(), claimed.lease, {block_event(0)})), StoreErrorCode::kLeaseLost
    );
    EXPECT_EQ(error_of(jobs().finish(claimed.lease, succeeded())), StoreErrorCode::kLeaseLost);
    EXPECT_EQ(error_of(jobs().release(claimed.lease, 0)), StoreErrorCode::kLeaseLost);
    between_steps();
    EXPECT_FALSE(claim());
}

TEST_P(JobContract, ErasingAJobTakesTheFilesThatNothingElseUses) {
    std::vector<std::string> digests;
    for (const char* id : {"a", "b"}) {
        const auto own = value(artifacts().put(std::string("only of ") + id));
        const auto shared = value(artifacts().put("of both"));
        const Claim claimed = submit_and_claim(id);
        value(jobs().finish(
            claimed.lease, succeeded({{"own", own->digest()}, {"shared", shared->digest()}})
        ));
        digests = {own->digest(), shared->digest()};
    }
    between_steps();
    const std::string own_of_a = value(jobs().artifact("a", "own"));
    value(jobs().erase("a"));
    EXPECT_TRUE(eventually([&] { return !artifacts().open(own_of_a); }));
    settle();
    EXPECT_EQ(value(artifacts().load(digests[0])), "only of b");
    EXPECT_EQ(value(artifacts().load(digests[1])), "of both");
    EXPECT_EQ(error_of(jobs().artifact("a", "own")), StoreErrorCode::kNotFound);
    value(jobs().erase("b"));
    EXPECT_TRUE(eventually([&] { return !artifacts().open(digests[1]); }));
}

TEST_P(JobContract, AnExpiredJobStaysWithoutItsArtifacts) {
    const auto pin = value(artifacts().put("model"));
    const Claim claimed = submit_and_claim("a");
    const proto::Job ended =
        value(jobs().finish(claimed.lease, succeeded({{"model", pin->digest()}})));
    ASSERT_EQ(ended.expires, kNow + 2 + kRetentionMs);
    jobs().expire(*ended.expires);  // not before it
    EXPECT_EQ(value(jobs().artifact("a", "model")), pin->digest());
    jobs().expire(*ended.expires + 1);
    jobs().expire(*ended.expires + 1);
    EXPECT_EQ(error_of(jobs().artifact("a", "model")), StoreErrorCode::kNotFound);
    EXPECT_EQ(find("a").state, proto::JobState::kSucceeded);
    EXPECT_EQ(find("a").result, succeeded().result);
    EXPECT_EQ(log("a").size(), 2U);
}

TEST_P(JobContract, WhatExpiresLeavesNoFile) {
    std::string digest;
    {
        const auto pin = value(artifacts().put("model"));
        digest = pin->digest();
        const Claim claimed = submit_and_claim("a");
        value(jobs().finish(claimed.lease, succeeded({{"model", digest}})));
    }
    between_steps();
    jobs().expire(kNow + 3 + kRetentionMs);
    EXPECT_TRUE(eventually([&] { return !artifacts().open(digest); }));
}

TEST_P(JobContract, UnfinishedJobsDoNotExpire) {
    Claim claimed = submit_and_claim("a");
    Progress progress = progress_of(1);
    progress.checkpoint = JobCheckpoint{0, 1, "1", "labels"};
    value(append(jobs(), claimed.lease, {block_event(0)}, progress));
    jobs().expire(std::numeric_limits<proto::UnixMillis>::max());
    EXPECT_TRUE(value(jobs().checkpoint("a")));
}

TEST_P(JobContract, AnArtifactIsLinkedOnceByName) {
    std::string first;
    {
        const auto one = value(artifacts().put("one"));
        const auto two = value(artifacts().put("two"));
        const Claim claimed = submit_and_claim("a");
        value(jobs().finish(claimed.lease, succeeded()));
        first = one->digest();
        value(jobs().link("a", {"preview", first}));
        value(jobs().link("a", {"preview", first}));
        value(jobs().link("a", {"preview", two->digest()}));
    }
    between_steps();
    EXPECT_EQ(value(jobs().artifact("a", "preview")), first);
    EXPECT_EQ(value(artifacts().load(first)), "one");
    EXPECT_TRUE(eventually([&] { return !artifacts().open(sha256_hex("two")); }));
}

TEST_P(JobContract, LinkingWhatIsNotThereFails) {
    const auto pin = value(artifacts().put("one"));
    EXPECT_EQ(error_of(jobs().link("none", {"x", pin->digest()})), StoreErrorCode::kNotFound);
    const Claim claimed = submit_and_claim("a");
    value(jobs().finish(claimed.lease, succeeded()));
    for (const std::string& digest :
         {sha256_hex("never stored"),
          std::string(),
          std::string("abc"),
          std::string("../../lock"),
          std::string(64, 'Z')}) {
        EXPECT_EQ(error_of(jobs().link("a", {"x", digest})), StoreErrorCode::kConflict) << digest;
    }
    EXPECT_EQ(error_of(jobs().artifact("a", "x")), StoreErrorCode::kNotFound);
}

TEST_P(JobContract, HardTextSurvives) {
    NewJob job = keyed_job(std::string("a\0b", 3), hard_text("key"), hard_text("hash"));
    job.request = hard_text("request");
    job.solver = hard_text("solver");
    job.deadline_seconds = 1.0 / 3;
    submit(job);
    between_steps();
    EXPECT_EQ(find(job.id).request, job.request);
    EXPECT_EQ(find(job.id).solver, job.solver);
    EXPECT_EQ(value(jobs().find_key("", job.idempotency_key, job.request_hash))->id, job.id);
    EXPECT_EQ(error_of(jobs().find("a")), StoreErrorCode::kNotFound);

    const auto claimed = claim();
    ASSERT_TRUE(claimed);
    EXPECT_EQ(claimed->lease.job_id, job.id);
    EXPECT_EQ(claimed->deadline_seconds, job.deadline_seconds);
    Progress progress = progress_of(1);
    progress.solver_version = hard_text("version");
    progress.checkpoint = JobCheckpoint{0, 1, hard_text("tally"), random_bytes(100'000, 1)};
    const NewEvent event{hard_text("type"), hard_text("fields"), -1};
    value(append(jobs(), claimed->lease, {event}, progress));
    EXPECT_EQ(value(jobs().checkpoint(job.id))->labels, progress.checkpoint->labels);
    value(jobs().release(claimed->lease, 0.1));
    between_steps();
    const auto again = claim();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->solver_version, progress.solver_version);
    EXPECT_EQ(again->checkpoint->labels, progress.checkpoint->labels);
    const auto pin = value(artifacts().put("x"));
    Outcome outcome = succeeded({{hard_text("name"), pin->digest()}});
    outcome.result = hard_text("result");
    value(jobs().finish(again->lease, outcome));
    EXPECT_EQ(value(jobs().artifact(job.id, hard_text("name"))), pin->digest());
    EXPECT_EQ(find(job.id).result, outcome.result);
    const std::vector<Event> events_of_job = log(job.id);
    ASSERT_EQ(events_of_job.size(), 3U);
    EXPECT_EQ(tuple_of(events_of_job[1]), EventTuple(2, event.type, event.fields, -1));
    EXPECT_EQ(events_of_job[2].fields, proto::succeeded_fields(outcome.result));
}

TEST_P(JobContract, HardTextOfErrorsSurvives) {
    const Claim claimed = submit_and_claim("a");
    Outcome outcome = failed();
    outcome.error = hard_text("error");
    value(jobs().finish(claimed.lease, outcome));
    between_steps();
    EXPECT_EQ(find("a").error, outcome.error);
    EXPECT_EQ(find("a").result, "");
    EXPECT_EQ(log("a").back().fields, proto::failed_fields(outcome.error));
}

}  // namespace modelsynth::server
