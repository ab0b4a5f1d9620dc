// What a job's holder writes while it runs.

#include "tests/unit/server/store_suite.h"

#include <algorithm>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ProgressContract);

namespace {

Progress with_checkpoint(std::uint32_t blocks_done, std::string labels) {
    Progress progress = progress_of(blocks_done);
    // The seq that the caller gives is not looked at.
    progress.checkpoint =
        JobCheckpoint{999, blocks_done, std::to_string(blocks_done / 2), std::move(labels)};
    return progress;
}

void expect_checkpoint(
    const std::optional<JobCheckpoint>& checkpoint, const JobCheckpoint& expected
) {
    ASSERT_TRUE(checkpoint);
    EXPECT_EQ(checkpoint->seq, expected.seq);
    EXPECT_EQ(checkpoint->blocks_done, expected.blocks_done);
    EXPECT_EQ(checkpoint->tally, expected.tally);
    EXPECT_EQ(checkpoint->labels, expected.labels);
}

}  // namespace

TEST_P(ProgressContract, AppendNumbersOnFromTheNewestEvent) {
    const Claim claimed = submit_and_claim("a");
    EXPECT_EQ(value(append(jobs(), claimed.lease, {block_event(0)})), 2U);
    EXPECT_EQ(
        value(append(jobs(), claimed.lease, {block_event(1), block_event(2)}, progress_of(3))), 3U
    );
    EXPECT_EQ(value(append(jobs(), claimed.lease, {block_event(3)}, progress_of(4))), 5U);
    between_steps();
    const std::vector<Event> events_of_a = log("a");
    ASSERT_EQ(events_of_a.size(), 5U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(events_of_a[i + 1].fields, block_event(i).fields);
    }
    EXPECT_EQ(find("a").blocks_done, 4U);
    EXPECT_EQ(find("a").blocks_total, 100U);
}

TEST_P(ProgressContract, AppendTellsInTheOrderOfTheCalls) {
    constexpr std::size_t kAppends = 300;
    const Claim claimed = submit_and_claim("a");
    std::mutex mutex;
    std::vector<std::uint64_t> firsts;
    std::promise<void> all_told;
    for (std::size_t i = 0; i < kAppends; ++i) {
        // Every third one has two events.
        std::vector<NewEvent> appended(i % 3 == 0 ? 2 : 1, block_event(i));
        jobs().append(
            claimed.lease,
            std::move(appended),
            progress_of(static_cast<std::uint32_t>(i)),
            [&](const Stored<std::uint64_t>& first) {
                const std::lock_guard lock(mutex);
                firsts.push_back(first.value_or(0));
                if (firsts.size() == kAppends) {
                    all_told.set_value();
                }
            }
        );
    }
    all_told.get_future().wait();
    const std::lock_guard until_the_last_one_has_left(mutex);
    std::uint64_t expected = 2;
    for (std::size_t i = 0; i < kAppends; ++i) {
        ASSERT_EQ(firsts[i], expected);
        expected += i % 3 == 0 ? 2 : 1;
    }
    between_steps();
    EXPECT_EQ(log("a").size(), expected - 1);
}

// While the store is busy with something else what waits may be written at once; every append keeps
// its events, its number and its checkpoint.
TEST_P(ProgressContract, WhatWaitsForABusyStoreIsWrittenAsItWasGiven) {
    const Claim claimed = submit_and_claim("a");
    const Claim other = submit_and_claim("b");
    std::promise<void> is_busy;
    std::promise<void> go_on;
    jobs().append(other.lease, {block_event(0)}, progress_of(1), [&](const auto&) {
        is_busy.set_value();
        go_on.get_future().wait();
    });
    is_busy.get_future().wait();
    constexpr std::uint32_t kAppends = 100;
    std::vector<std::promise<Stored<std::uint64_t>>> told(kAppends);
    for (std::uint32_t i = 0; i < kAppends; ++i) {
        const bool is_checkpoint = i % 7 == 3 && i < 50;
        std::vector<NewEvent> appended(i % 4, block_event(i));
        jobs().append(
            i % 5 == 4 ? other.lease : claimed.lease,
            std::move(appended),
            is_checkpoint ? with_checkpoint(i, std::to_string(i)) : progress_of(i),
            [&told, i](const Stored<std::uint64_t>& first) { told[i].set_value(first); }
        );
    }
    go_on.set_value();
    std::map<std::string, std::uint64_t> next = {{"a", 2}, {"b", 3}};
    std::map<std::string, std::vector<std::string>> fields;
    for (std::uint32_t i = 0; i < kAppends; ++i) {
        const std::string job = i % 5 == 4 ? "b" : "a";
        EXPECT_EQ(value(told[i].get_future().get()), next[job]) << i;
        next[job] += i % 4;
        fields[job].insert(fields[job].end(), i % 4, block_event(i).fields);
        if (i == 45) {  // the last checkpoint of "a"
            expect_checkpoint(
                value(jobs().checkpoint("a")), {next[job] - 1, i, std::to_string(i / 2), "45"}
            );
        }
    }
    between_steps();
    for (const std::string job : {"a", "b"}) {
        std::vector<std::string> logged;
        for (const Event& event : log(job)) {
            logged.push_back(event.fields);
        }
        ASSERT_EQ(logged.size(), next[job] - 1);
        EXPECT_TRUE(std::equal(fields[job].rbegin(), fields[job].rend(), logged.rbegin())) << job;
    }
    EXPECT_EQ(find("a").blocks_done, 98U);
    EXPECT_EQ(find("b").blocks_done, 99U);
}

TEST_P(ProgressContract, WhatWasToldIsThereToRead) {
    const Claim claimed = submit_and_claim("a");
    for (std::uint64_t i = 0; i < 5; ++i) {
        const std::uint64_t first = value(append(jobs(), claimed.lease, {block_event(i)}));
        const EventPage page = value(events().read("a", first - 1, 10));
        ASSERT_EQ(page.events.size(), 1U);
        EXPECT_EQ(page.events.front().seq, first);
        EXPECT_EQ(page.head, first);
        EXPECT_FALSE(page.ended);
    }
}

TEST_P(ProgressContract, AnAppendThatFailsLeavesItsNeighboursAlone) {
    const Claim claimed = submit_and_claim("a");
    const Claim other = submit_and_claim("b");

    enum Kind : std::uint8_t { kGood, kOfNoJob, kNotStored };

    std::mutex mutex;
    std::map<std::string, std::vector<std::size_t>> told_of_job;
    std::map<std::size_t, std::optional<StoreErrorCode>> told;
    std::promise<void> all_told;
    constexpr std::size_t kAppends = 60;
    for (std::size_t i = 0; i < kAppends; ++i) {
        const Lease lease = i % 3 == kGood        ? claimed.lease
                            : i % 3 == kNotStored ? other.lease
                                                  : Lease{"none", claimed.lease.token};
        Progress progress = with_checkpoint(static_cast<std::uint32_t>(i), std::to_string(i));
        if (i % 3 == kNotStored) {
            progress.artifacts = {{"model.glb", std::string(64, '0')}};
        }
        jobs().append(lease, {block_event(i)}, progress, [&, i, lease](const auto& first) {
            const std::lock_guard lock(mutex);
            told[i] = error_of(first);
            told_of_job[lease.job_id].push_back(i);
            if (told.size() == kAppends) {
                all_told.set_value();
            }
        });
    }
    all_told.get_future().wait();
    const std::lock_guard until_the_last_one_has_left(mutex);
    for (std::size_t i = 0; i < kAppends; ++i) {
        // After the first one of a job that fails, the others would leave a gap.
        const auto expected = i % 3 == kGood      ? std::nullopt
                              : i % 3 == kOfNoJob ? std::optional(StoreErrorCode::kLeaseLost)
                              : i == kNotStored   ? std::optional(StoreErrorCode::kConflict)
                                                  : std::optional(StoreErrorCode::kUnavailable);
        EXPECT_EQ(told[i], expected) << i;
    }
    for (const auto& [job, order] : told_of_job) {
        EXPECT_TRUE(std::is_sorted(order.begin(), order.end())) << job;
    }
    EXPECT_EQ(log("a").size(), 1 + kAppends / 3);
    EXPECT_EQ(log("b").size(), 1U);
    EXPECT_EQ(value(jobs().checkpoint("a"))->labels, "57");
    EXPECT_FALSE(value(jobs().checkpoint("none")));
}

TEST_P(ProgressContract, TheCheckpointStandsForTheLastEventOfItsAppend) {
    const Claim claimed = submit_and_claim("a");
    EXPECT_FALSE(value(jobs().checkpoint("a")));
    value(append(jobs(), claimed.lease, {block_event(0), block_event(1)}, with_checkpoint(2, "two"))
    );
    expect_checkpoint(value(jobs().checkpoint("a")), {3, 2, "1", "two"});
    // One without keeps it.
    value(append(jobs(), claimed.lease, {block_event(2)}, progress_of(3)));
    expect_checkpoint(value(jobs().checkpoint("a")), {3, 2, "1", "two"});
    value(append(jobs(), claimed.lease, {block_event(3)}, with_checkpoint(4, "four")));
    expect_checkpoint(value(jobs().checkpoint("a")), {5, 4, "2", "four"});
    // With no event it stands for what is there.
    value(append(jobs(), claimed.lease, {}, with_checkpoint(4, "")));
    expect_checkpoint(value(jobs().checkpoint("a")), {5, 4, "2", ""});
}

TEST_P(ProgressContract, AClaimGivesTheLatestCheckpointBack) {
    const std::string labels = random_bytes(50'000, 3);
    const Claim first = submit_and_claim("a");
    value(append(jobs(), first.lease, {block_event(0)}, with_checkpoint(1, "older")));
    value(append(jobs(), first.lease, {block_event(1)}, with_checkpoint(2, labels)));
    value(jobs().release(first.lease, 1));
    between_steps();
    const auto released = claim();
    ASSERT_TRUE(released);
    expect_checkpoint(released->checkpoint, {3, 2, "1", labels});
    value(append(jobs(), released->lease, {block_event(2)}, progress_of(3)));
    reopen();
    const auto crashed = claim();
    ASSERT_TRUE(crashed);
    expect_checkpoint(crashed->checkpoint, {3, 2, "1", labels});
    EXPECT_EQ(crashed->job.blocks_done, 3U);
}

TEST_P(ProgressContract, AnotherSolverVersionDropsTheCheckpointAndTellsWhereItBegan) {
    const Claim first = submit_and_claim("a");
    value(append(jobs(), first.lease, {block_event(0)}, with_checkpoint(1, "older")));
    value(jobs().release(first.lease, 1));
    between_steps();
    const auto second = claim();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->version_base, 1U);
    Progress progress = progress_of(0);
    progress.solver_version = "v2";
    value(append(jobs(), second->lease, {{"started", "{}", kNow}}, progress));
    EXPECT_FALSE(value(jobs().checkpoint("a")));
    // The crash comes before any block under it.
    reopen();
    const auto third = claim();
    ASSERT_TRUE(third);
    EXPECT_EQ(third->solver_version, "v2");
    EXPECT_EQ(third->version_base, 2U);
    EXPECT_FALSE(third->checkpoint);
    // One of the same append is of the new version.
    progress = with_checkpoint(1, "newer");
    progress.solver_version = "v3";
    value(append(jobs(), third->lease, {block_event(0)}, progress));
    expect_checkpoint(value(jobs().checkpoint("a")), {4, 1, "0", "newer"});
    // The same version changes nothing.
    progress = progress_of(2);
    progress.solver_version = "v3";
    value(append(jobs(), third->lease, {block_event(1)}, progress));
    value(jobs().release(third->lease, 1));
    EXPECT_EQ(claim()->version_base, 3U);
}

TEST_P(ProgressContract, AnOldHolderWritesNoCheckpoint) {
    const Claim old = submit_and_claim("a");
    value(append(jobs(), old.lease, {block_event(0)}, with_checkpoint(1, "good")));
    value(jobs().release(old.lease, 1));
    ASSERT_TRUE(claim());
    EXPECT_EQ(
        error_of(append(jobs(), old.lease, {block_event(1)}, with_checkpoint(2, "late"))),
        StoreErrorCode::kLeaseLost
    );
    expect_checkpoint(value(jobs().checkpoint("a")), {2, 1, "0", "good"});
}

TEST_P(ProgressContract, TheCheckpointGoesWhenTheJobSucceeds) {
    auto pin = value(artifacts().put("labels"));
    const Claim claimed = submit_and_claim("a");
    value(append(jobs(), claimed.lease, {block_event(0)}, with_checkpoint(1, "x")));
    value(jobs().finish(claimed.lease, succeeded({{"labels", pin->digest()}})));
    pin.reset();
    between_steps();
    EXPECT_FALSE(value(jobs().checkpoint("a")));
}

TEST_P(ProgressContract, TheCheckpointGoesWhenTheJobSucceedsWithoutArtifacts) {
    const Claim claimed = submit_and_claim("a");
    value(append(jobs(), claimed.lease, {block_event(0)}, with_checkpoint(1, "x")));
    value(jobs().finish(claimed.lease, succeeded()));
    between_steps();
    EXPECT_FALSE(value(jobs().checkpoint("a")));
}

TEST_P(ProgressContract, TheCheckpointStaysWithAFailedJobUntilItExpires) {
    const Claim claimed = submit_and_claim("a");
    value(append(jobs(), claimed.lease, {block_event(0)}, with_checkpoint(1, "x")));
    const proto::Job ended = value(jobs().finish(claimed.lease, failed()));
    between_steps();
    EXPECT_TRUE(value(jobs().checkpoint("a")));
    jobs().expire(*ended.expires);
    EXPECT_TRUE(value(jobs().checkpoint("a")));
    jobs().expire(*ended.expires + 1);
    EXPECT_FALSE(value(jobs().checkpoint("a")));
    EXPECT_EQ(find("a").state, proto::JobState::kFailed);
}

TEST_P(ProgressContract, TheCheckpointStaysWithACancelledJob) {
    const Claim running = submit_and_claim("a");
    value(append(jobs(), running.lease, {block_event(0)}, with_checkpoint(1, "x")));
    value(jobs().cancel("a", kNow));
    // A model is no preview: it is not kept, and tells nothing.
    auto pin = value(artifacts().put("glb"));
    value(jobs().finish(running.lease, succeeded({{"nodes.glb", pin->digest()}})));
    EXPECT_EQ(error_of(jobs().artifact("a", "nodes.glb")), StoreErrorCode::kNotFound);
    EXPECT_TRUE(value(jobs().checkpoint("a")));

    const Claim released = submit_and_claim("b");
    value(append(jobs(), released.lease, {block_event(0)}, with_checkpoint(1, "y")));
    value(jobs().release(released.lease, 0));
    value(jobs().cancel("b", kNow));
    pin.reset();
    between_steps();
    EXPECT_EQ(value(jobs().checkpoint("b"))->labels, "y");
}

TEST_P(ProgressContract, TheCheckpointGoesWhenLabelsTellThePreview) {
    auto pin = value(artifacts().put("labels"));
    const Claim claimed = submit_and_claim("a");
    value(append(jobs(), claimed.lease, {block_event(0)}, with_checkpoint(1, "x")));
    value(jobs().cancel("a", kNow));
    Outcome outcome = failed();
    outcome.state = proto::JobState::kCancelled;
    outcome.artifacts = {{"labels", pin->digest()}};
    value(jobs().finish(claimed.lease, outcome));
    pin.reset();
    between_steps();
    EXPECT_FALSE(value(jobs().checkpoint("a")));
    EXPECT_EQ(value(jobs().artifact("a", "labels")), sha256_hex("labels"));
}

TEST_P(ProgressContract, WhatIsLinkedWhileTheJobRunsStaysHoweverItEnds) {
    for (const char* end : {"succeeds", "fails", "cancelled", "released"}) {
        const Claim claimed = submit_and_claim(end);
        auto pin = value(artifacts().put(std::string("model of ") + end));
        const std::string digest = pin->digest();
        Progress progress = progress_of(1);
        progress.artifacts = {{"nodes.glb.1", digest}};
        value(append(jobs(), claimed.lease, {block_event(0)}, progress));
        if (std::string(end) == "cancelled") {
            value(jobs().cancel(end, kNow));
        }
        if (std::string(end) == "released") {
            value(jobs().release(claimed.lease, 0));
        } else {
            value(
                jobs().finish(claimed.lease, std::string(end) == "fails" ? failed() : succeeded({}))
            );
        }
        pin.reset();
        between_steps();
        EXPECT_EQ(value(jobs().artifact(end, "nodes.glb.1")), digest) << end;
        EXPECT_TRUE(artifacts().load(digest)) << end;
    }
}

TEST_P(ProgressContract, AnAppendWithWhatIsNotStoredDoesNothing) {
    const Claim claimed = submit_and_claim("a");
    Progress progress = progress_of(1);
    progress.artifacts = {{"nodes.glb.1", sha256_hex("nothing")}};
    EXPECT_EQ(
        error_of(append(jobs(), claimed.lease, {block_event(0)}, progress)),
        StoreErrorCode::kConflict
    );
    between_steps();
    EXPECT_EQ(log("a").size(), 1U);
    EXPECT_EQ(find("a").blocks_done, 0U);
}

TEST_P(ProgressContract, AnotherSolversModelsGoAndWhatTheJobWorksOnStays) {
    const std::string work = sha256_hex("work");
    {
        const auto pin = value(artifacts().put("work"));
        NewJob job = new_job("a");
        job.artifacts = {{"origin", work}, {"example", work}};
        submit(job);
    }
    const Claim claimed = *claim();
    {
        const auto pin = value(artifacts().put("model"));
        Progress progress = progress_of(1);
        progress.artifacts = {{"nodes.glb", pin->digest()}, {"labels.1", pin->digest()}};
        value(append(jobs(), claimed.lease, {block_event(0)}, progress));
    }
    Progress progress = progress_of(1);
    progress.solver_version = "another";
    value(append(jobs(), claimed.lease, {block_event(1)}, progress));
    between_steps();
    for (const char* name : {"nodes.glb", "labels.1"}) {
        EXPECT_EQ(error_of(jobs().artifact("a", name)), StoreErrorCode::kNotFound) << name;
    }
    EXPECT_TRUE(eventually([&] { return !artifacts().open(sha256_hex("model")); }));
    for (const char* name : {"origin", "example"}) {
        EXPECT_EQ(value(jobs().artifact("a", name)), work) << name;
    }
}

TEST_P(ProgressContract, TheCheckpointGoesWithAnErasedJob) {
    const Claim claimed = submit_and_claim("a");
    value(append(jobs(), claimed.lease, {block_event(0)}, with_checkpoint(1, "x")));
    value(jobs().erase("a"));
    submit(new_job("a"));
    between_steps();
    EXPECT_FALSE(value(jobs().checkpoint("a")));
    EXPECT_FALSE(claim()->checkpoint);
}

}  // namespace modelsynth::server
