// The log of events as its readers see it.

#include "tests/unit/server/store_suite.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EventContract);

TEST_P(EventContract, ReadingFromEveryOffsetGivesTheTail) {
    const Claim claimed = submit_and_claim("a");
    std::vector<NewEvent> blocks;
    for (std::size_t i = 0; i < 30; ++i) {
        blocks.push_back(block_event(i));
    }
    value(append(jobs(), claimed.lease, blocks));
    value(jobs().finish(claimed.lease, failed()));
    between_steps();
    const std::vector<EventTuple> whole = tuples_of(log("a"));
    ASSERT_EQ(whole.size(), 32U);
    for (std::size_t after = 0; after <= whole.size(); ++after) {
        for (const std::size_t limit : {1U, 7U, 31U, 32U, 500U}) {
            const EventPage page = value(events().read("a", after, limit));
            const auto first = whole.begin() + static_cast<std::ptrdiff_t>(after);
            const std::size_t count = std::min(limit, whole.size() - after);
            EXPECT_EQ(
                tuples_of(page.events),
                std::vector<EventTuple>(first, first + static_cast<std::ptrdiff_t>(count))
            );
            EXPECT_EQ(page.head, 32U);
            EXPECT_TRUE(page.ended);
        }
    }
}

TEST_P(EventContract, ReadingPastTheHeadGivesNothing) {
    submit(new_job("a"));
    between_steps();
    for (const std::uint64_t after :
         {std::uint64_t{1},
          std::uint64_t{2},
          std::uint64_t{1} << 63,
          std::numeric_limits<std::uint64_t>::max()}) {
        const EventPage page = value(events().read("a", after, 10));
        EXPECT_TRUE(page.events.empty()) << after;
        EXPECT_EQ(page.head, 1U);
        EXPECT_FALSE(page.ended);
    }
    EXPECT_TRUE(value(events().read("a", 0, 0)).events.empty());
}

TEST_P(EventContract, ManyAppendersAtOnceLeaveEveryLogGapless) {
    constexpr std::size_t kAppenders = 16;
    constexpr std::size_t kAppends = 25;
    std::vector<Claim> claims;
    for (std::size_t i = 0; i < kAppenders; ++i) {
        claims.push_back(submit_and_claim("job" + std::to_string(i)));
    }
    run_together(kAppenders, [&](std::size_t appender) {
        for (std::size_t i = 0; i < kAppends; ++i) {
            value(append(
                jobs(),
                claims[appender].lease,
                std::vector<NewEvent>(1 + i % 2, block_event(i)),
                progress_of(static_cast<std::uint32_t>(i))
            ));
        }
        value(jobs().finish(claims[appender].lease, failed()));
    });
    between_steps();
    for (const Claim& claimed : claims) {
        const std::vector<Event> events_of_job = log(claimed.lease.job_id);
        ASSERT_EQ(events_of_job.size(), 2 + kAppends + kAppends / 2);
        std::size_t at = 1;
        for (std::size_t i = 0; i < kAppends; ++i) {
            for (std::size_t copy = 0; copy < 1 + i % 2; ++copy) {
                EXPECT_EQ(events_of_job[at++].fields, block_event(i).fields);
            }
        }
        EXPECT_EQ(events_of_job.back().type, "failed");
    }
}

TEST_P(EventContract, AReaderBesideTheWriterMissesNothing) {
    constexpr std::size_t kEvents = 60;
    const Claim claimed = submit_and_claim("a");
    std::vector<std::string> seen;
    run_together(2, [&](std::size_t thread) {
        if (thread == 0) {
            for (std::size_t i = 0; i < kEvents; ++i) {
                value(append(jobs(), claimed.lease, {block_event(i)}));
            }
            value(jobs().finish(claimed.lease, failed()));
            return;
        }
        for (;;) {
            const EventPage page = value(events().read("a", seen.size(), 7));
            for (const Event& event : page.events) {
                EXPECT_EQ(event.seq, seen.size() + 1);
                seen.push_back(event.fields);
            }
            EXPECT_LE(seen.size(), page.head);
            if (page.ended && seen.size() == page.head) {
                return;
            }
        }
    });
    ASSERT_EQ(seen.size(), kEvents + 2);
    for (std::size_t i = 0; i < kEvents; ++i) {
        EXPECT_EQ(seen[i + 1], block_event(i).fields);
    }
}

TEST_P(EventContract, ASubscriberIsToldAfterEachCommitOfItsJob) {
    submit(new_job("other"));
    submit(new_job("a", 1));
    std::atomic<int> told = 0;
    std::atomic<int> told_of_other = 0;
    const auto subscription = events().subscribe("a", EventLog::News::kAny, [&told] { ++told; });
    const auto other =
        events().subscribe("other", EventLog::News::kAny, [&told_of_other] { ++told_of_other; });
    auto is_told = [&told, expected = 0]() mutable {
        ++expected;
        return eventually([&] { return told >= expected; });
    };
    const auto claimed = claim();
    ASSERT_TRUE(claimed);
    settle();
    told = 0;  // a claim may tell, or not
    value(append(jobs(), claimed->lease, {block_event(0)}));
    EXPECT_TRUE(is_told());
    value(append(jobs(), claimed->lease, {block_event(1)}));
    EXPECT_TRUE(is_told());
    value(jobs().finish(claimed->lease, failed()));
    EXPECT_TRUE(is_told());
    value(jobs().erase("a"));
    EXPECT_TRUE(is_told());
    settle();
    EXPECT_EQ(told_of_other, 0);
    value(jobs().cancel("other", kNow));
    EXPECT_TRUE(eventually([&] { return told_of_other > 0; }));
}

TEST_P(EventContract, WhoWaitsForTheEndIsToldOfNothingElse) {
    using News = EventLog::News;
    const Claim claimed = submit_and_claim("a");
    submit(new_job("cancelled", 1));
    std::atomic<int> told_of_all = 0;
    std::atomic<int> told = 0;
    std::atomic<int> told_of_cancelled = 0;
    const auto all = events().subscribe("a", News::kAny, [&told_of_all] { ++told_of_all; });
    const auto end = events().subscribe("a", News::kEnd, [&told] { ++told; });
    const auto other =
        events().subscribe("cancelled", News::kEnd, [&told_of_cancelled] { ++told_of_cancelled; });
    value(append(jobs(), claimed.lease, {block_event(0)}));
    EXPECT_TRUE(eventually([&] { return told_of_all > 0; }));
    EXPECT_EQ(told, 0);
    value(jobs().finish(claimed.lease, failed()));
    EXPECT_TRUE(eventually([&] { return told == 1; }));
    value(jobs().cancel("cancelled", kNow));
    EXPECT_TRUE(eventually([&] { return told_of_cancelled == 1; }));
    value(jobs().erase("a"));
    EXPECT_TRUE(eventually([&] { return told == 2; }));
}

TEST_P(EventContract, AllSubscribersOfAJobAreToldNeverTwoCallsOfOneAtOnce) {
    constexpr std::size_t kSubscribers = 20;
    constexpr std::uint32_t kAppends = 20;

    struct Listener {
        std::atomic<int> told = 0;
        std::atomic<bool> is_running = false;
        std::atomic<bool> overlapped = false;
    };

    std::vector<Listener> listeners(kSubscribers);
    std::vector<std::unique_ptr<EventLog::Subscription>> subscriptions;
    for (Listener& listener : listeners) {
        subscriptions.push_back(events().subscribe("a", EventLog::News::kAny, [&listener] {
            listener.overlapped = listener.overlapped || listener.is_running.exchange(true);
            ++listener.told;
            listener.is_running = false;
        }));
    }
    // One may subscribe to what is not there yet.
    const Claim claimed = submit_and_claim("a");
    run_together(4, [&](std::size_t) {
        for (std::uint32_t i = 0; i < kAppends / 4; ++i) {
            value(append(jobs(), claimed.lease, {block_event(i)}, progress_of(i)));
        }
    });
    for (const Listener& listener : listeners) {
        EXPECT_TRUE(eventually([&listener] { return listener.told >= 2; }));
        EXPECT_FALSE(listener.overlapped);
    }
    EXPECT_EQ(log("a").size(), 1 + kAppends);
}

TEST_P(EventContract, NobodyIsToldAfterTheSubscriptionHasEnded) {
    const Claim claimed = submit_and_claim("a");
    std::atomic<int> told = 0;
    auto subscription = events().subscribe("a", EventLog::News::kAny, [&told] { ++told; });
    value(append(jobs(), claimed.lease, {block_event(0)}));
    subscription.reset();
    const int before = told;
    value(append(jobs(), claimed.lease, {block_event(1)}));
    settle();
    EXPECT_EQ(told, before);
}

TEST_P(EventContract, SubscribersComeAndGoWhileTheJobIsWritten) {
    constexpr int kAppends = 40;
    const Claim claimed = submit_and_claim("a");
    std::atomic<bool> is_done = false;
    std::atomic<bool> told_the_dead = false;
    run_together(4, [&](std::size_t thread) {
        if (thread == 0) {
            for (int i = 0; i < kAppends; ++i) {
                value(append(jobs(), claimed.lease, {block_event(0)}));
            }
            is_done = true;
            return;
        }
        while (!is_done) {
            // Gone with the round: a late call would be seen, at the latest by a sanitizer.
            const auto is_alive = std::make_unique<std::atomic<bool>>(true);
            auto subscription = events().subscribe(
                "a",
                EventLog::News::kAny,
                [&told_the_dead, alive = is_alive.get()] {
                    told_the_dead = told_the_dead || !*alive;
                }
            );
            std::this_thread::yield();
            subscription.reset();
            *is_alive = false;
        }
    });
    EXPECT_FALSE(told_the_dead);
    EXPECT_EQ(log("a").size(), 1U + kAppends);
}

}  // namespace modelsynth::server
