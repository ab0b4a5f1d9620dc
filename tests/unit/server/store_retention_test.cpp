// What the embedded store gives up, and what it does not.

#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>

#include <limits>

namespace modelsynth::server {
namespace {

class StoreRetention : public testing::Test {
  protected:
    std::string put(const std::string& bytes) {
        return value(store_.artifacts().put(bytes))->digest();
    }

    // A job that ended so long after kNow with an artifact of these bytes.
    void end(const std::string& id, const std::string& bytes, proto::UnixMillis after) {
        value(store_.jobs().submit(new_job(id), kNoLimit));
        const auto claim = value(store_.jobs().claim(kNow, {}));
        const auto pin = value(store_.artifacts().put(bytes));
        Outcome outcome = succeeded({{"nodes.glb", pin->digest()}});
        outcome.finished = kNow + after;
        value(store_.jobs().finish(claim.value().lease, outcome));
    }

    bool has(const std::string& bytes) {
        return store_.artifacts().load(sha256_hex(bytes)).has_value();
    }

    std::uint64_t used() { return store_.artifacts().space().used_bytes; }

    EmbeddedStore store_;
};

const std::string kOne(1000, '1');
const std::string kTwo(1000, '2');
const std::string kThree(1000, '3');

TEST_F(StoreRetention, CountsEachFileOnceAlsoAfterAStart) {
    EXPECT_EQ(used(), 0U);
    end("a", kOne, 1);
    end("b", kOne, 2);
    end("c", kTwo, 3);
    EXPECT_EQ(used(), 2000U);
    store_.reopen();
    EXPECT_EQ(used(), 2000U);
    value(store_.jobs().erase("a"));
    EXPECT_EQ(used(), 2000U);
    value(store_.jobs().erase("b"));
    EXPECT_TRUE(eventually([this] { return used() == 1000; }));
    EXPECT_GT(store_.artifacts().space().free_bytes, 0U);
}

TEST_F(StoreRetention, ShedsTheOldestUntilTheRestFits) {
    end("late", kThree, 30);
    end("early", kOne, 10);
    end("middle", kTwo, 20);
    store_.jobs().shed(3000, kNow + 40);
    EXPECT_EQ(used(), 3000U);
    store_.jobs().shed(2999, kNow + 40);
    EXPECT_TRUE(eventually([this] { return used() == 2000; }));
    EXPECT_FALSE(has(kOne));
    EXPECT_TRUE(has(kTwo) && has(kThree));
    // The job tells that it has expired.
    EXPECT_LT(value(store_.jobs().find("early")).expires, kNow + 40);
    EXPECT_GT(value(store_.jobs().find("middle")).expires, kNow + 40);
    EXPECT_EQ(error_of(store_.jobs().artifact("early", "nodes.glb")), StoreErrorCode::kNotFound);
    store_.jobs().shed(0, kNow + 40);
    EXPECT_TRUE(eventually([this] { return used() == 0; }));
}

TEST_F(StoreRetention, WhatOthersNeedStays) {
    end("origin", kOne, 1);
    end("other", kTwo, 2);
    NewJob next = new_job("next");
    next.artifacts = {{"origin", sha256_hex(kOne)}};
    value(store_.jobs().submit(next, kNoLimit));
    // What is taken of "origin" frees nothing, so "other" goes as well.
    store_.jobs().shed(1500, kNow + 10);
    EXPECT_TRUE(eventually([this] { return used() == 1000; }));
    EXPECT_TRUE(has(kOne));
    EXPECT_EQ(value(store_.jobs().artifact("next", "origin")), sha256_hex(kOne));
}

TEST_F(StoreRetention, ForgetsEndedJobsWithTheirEvents) {
    end("a", kOne, 1);
    end("b", kTwo, 2);
    value(store_.jobs().submit(new_job("queued"), kNoLimit));
    store_.jobs().forget(kNow + 1 + kRetentionMs);  // not before it expired
    EXPECT_TRUE(store_.jobs().find("a"));
    store_.jobs().forget(kNow + 2 + kRetentionMs);
    EXPECT_EQ(error_of(store_.jobs().find("a")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(store_.events().read("a", 0, 10)), StoreErrorCode::kNotFound);
    EXPECT_TRUE(eventually([this] { return !has(kOne); }));
    EXPECT_TRUE(store_.jobs().find("b"));
    store_.jobs().forget(std::numeric_limits<proto::UnixMillis>::max());
    EXPECT_EQ(error_of(store_.jobs().find("b")), StoreErrorCode::kNotFound);
    EXPECT_TRUE(store_.jobs().find("queued"));
}

}  // namespace
}  // namespace modelsynth::server
