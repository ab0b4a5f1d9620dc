// Messages about the ends of jobs.

#include "tests/unit/server/store_suite.h"

#include <atomic>
#include <string>
#include <vector>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DeliveryContract);

namespace {

NewJob hooked_job(const std::string& id, const std::string& url = "https://a.example/hook") {
    NewJob job = new_job(id);
    job.webhook = url;
    return job;
}

std::vector<std::string> ids_of(const DueDeliveries& due) {
    std::vector<std::string> ids;
    for (const Delivery& delivery : due.items) {
        ids.push_back(delivery.job_id);
    }
    return ids;
}

using Ids = std::vector<std::string>;

}  // namespace

TEST_P(DeliveryContract, EveryEndOfAJobWithAWebhookIsDue) {
    submit(hooked_job("succeeds"));
    value(jobs().finish(claim()->lease, succeeded()));
    between_steps();
    submit(hooked_job("fails"));
    value(jobs().finish(claim()->lease, failed()));
    between_steps();
    submit(hooked_job("stops"));
    const auto lease = claim()->lease;
    value(jobs().cancel("stops", kNow));
    value(jobs().finish(lease, succeeded()));
    value(jobs().finish(lease, succeeded()));
    between_steps();
    submit(hooked_job("waits"));
    value(jobs().cancel("waits", kNow));
    submit(new_job("has none"));
    value(jobs().cancel("has none", kNow));
    between_steps();
    const auto due = value(deliveries().due_deliveries(proto::now_millis(), 10, 10));
    EXPECT_EQ(due.items.size(), 4U);
    for (const Delivery& delivery : due.items) {
        EXPECT_EQ(delivery.url, "https://a.example/hook");
        EXPECT_EQ(delivery.receiver, "https://a.example");
        EXPECT_EQ(delivery.tries, 0U);
    }
}

TEST_P(DeliveryContract, NothingIsDueBeforeTheEnd) {
    submit(hooked_job("a"));
    EXPECT_TRUE(value(deliveries().due_deliveries(proto::now_millis(), 10, 10)).items.empty());
    const auto lease = claim()->lease;
    value(jobs().release(lease, 1));
    EXPECT_TRUE(value(deliveries().due_deliveries(proto::now_millis(), 10, 10)).items.empty());
}

TEST_P(DeliveryContract, OneThatIsPostponedComesAgainAndOneThatIsDroppedDoesNot) {
    submit(hooked_job("a"));
    value(jobs().cancel("a", kNow));
    value(deliveries().postpone_delivery("a", 2, kNow + 500));
    between_steps();
    const auto early = value(deliveries().due_deliveries(kNow + 499, 10, 10));
    EXPECT_TRUE(early.items.empty());
    EXPECT_EQ(early.next, kNow + 500);
    const auto due = value(deliveries().due_deliveries(kNow + 500, 10, 10));
    ASSERT_EQ(ids_of(due), Ids{"a"});
    EXPECT_EQ(due.items[0].tries, 2U);
    EXPECT_FALSE(due.next);
    value(deliveries().drop_delivery("a"));
    value(deliveries().drop_delivery("a"));
    between_steps();
    EXPECT_TRUE(value(deliveries().due_deliveries(kNow + 500, 10, 10)).items.empty());
}

TEST_P(DeliveryContract, ManyToOneReceiverDoNotHideThoseToOthers) {
    for (int i = 0; i < 5; ++i) {
        const std::string id = "a" + std::to_string(i);
        submit(hooked_job(id, i % 2 == 0 ? "https://A.example:1/x" : "https://a.example:1?y"));
        value(jobs().cancel(id, kNow + i));
    }
    submit(hooked_job("b", "https://a.example:2/x"));
    value(jobs().cancel("b", kNow + 10));
    const proto::UnixMillis later = kNow + 20;
    EXPECT_EQ(ids_of(value(deliveries().due_deliveries(later, 2, 10))), (Ids{"a0", "a1", "b"}));
    EXPECT_EQ(ids_of(value(deliveries().due_deliveries(later, 2, 1))), Ids{"a0"});
}

TEST_P(DeliveryContract, AnErasedJobTellsNobody) {
    submit(hooked_job("a"));
    value(jobs().cancel("a", kNow));
    value(jobs().erase("a"));
    EXPECT_TRUE(value(deliveries().due_deliveries(kNow, 10, 10)).items.empty());
}

TEST_P(DeliveryContract, AllThatAreNotDroppedCount) {
    const std::size_t others = value(deliveries().delivery_count());
    for (const char* id : {"a", "b", "c"}) {
        submit(hooked_job(id));
        EXPECT_EQ(value(deliveries().delivery_count()), others);
    }
    for (const char* id : {"a", "b", "c"}) {
        value(jobs().cancel(id, kNow));
    }
    value(deliveries().postpone_delivery("a", 1, kNow + 1'000'000));
    between_steps();
    EXPECT_EQ(value(deliveries().delivery_count()), others + 3);
    value(deliveries().drop_delivery("a"));
    value(jobs().erase("b"));
    between_steps();
    EXPECT_EQ(value(deliveries().delivery_count()), others + 1);
}

TEST_P(DeliveryContract, AnOwnerHasSoManyAndNoMore) {
    QueueLimits limits = kNoLimit;
    limits.deliveries_max = 2;
    const auto give = [&](const std::string& id, const std::string& owner, bool is_hooked = true) {
        NewJob job = is_hooked ? hooked_job(id) : new_job(id);
        job.owner = owner;
        job.idempotency_key = id;
        return error_of(jobs().submit(job, limits));
    };
    // What has not ended has nothing to deliver.
    for (const char* id : {"a1", "a2", "a3"}) {
        EXPECT_FALSE(give(id, "a"));
    }
    value(jobs().cancel("a1", kNow));
    EXPECT_FALSE(give("a4", "a"));
    value(jobs().cancel("a2", kNow));
    between_steps();
    EXPECT_EQ(give("a5", "a"), StoreErrorCode::kWebhooksFull);
    EXPECT_EQ(error_of(jobs().find("a5")), StoreErrorCode::kNotFound);
    // It counts for no one else, for no job without a webhook, and not for a repetition.
    EXPECT_FALSE(give("b1", "b"));
    EXPECT_FALSE(give("a6", "a", false));
    EXPECT_FALSE(give("a1", "a"));
    // Jobs that were taken end as before.
    value(jobs().cancel("a3", kNow));
    EXPECT_EQ(value(deliveries().due_deliveries(kNow, 10, 10)).items.size(), 3U);
    value(deliveries().postpone_delivery("a1", 1, kNow + 1'000'000));
    value(deliveries().drop_delivery("a2"));
    EXPECT_EQ(give("a5", "a"), StoreErrorCode::kWebhooksFull);
    value(jobs().erase("a3"));
    between_steps();
    EXPECT_FALSE(give("a5", "a"));
}

TEST_P(DeliveryContract, NewsAreToldOf) {
    std::atomic<int> told = 0;
    deliveries().on_delivery([&told] { ++told; });
    submit(hooked_job("a"));
    submit(new_job("b"));
    value(jobs().cancel("b", kNow));
    settle();
    EXPECT_EQ(told, 0);
    value(jobs().cancel("a", kNow));
    EXPECT_TRUE(eventually([&told] { return told > 0; }));
    deliveries().on_delivery(nullptr);
}

}  // namespace modelsynth::server
