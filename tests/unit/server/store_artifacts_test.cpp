// Files by the digest of their content.

#include "tests/unit/server/store_suite.h"

#include <random>
#include <set>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ArtifactContract);

namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

}  // namespace

TEST_P(ArtifactContract, TheDigestIsSha256) {
    EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(
        sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    );
}

TEST_P(ArtifactContract, BytesOfEverySizeComeBack) {
    const Claim claimed = submit_and_claim("a");
    Outcome outcome = succeeded();
    std::vector<std::string> contents;
    {
        std::vector<std::unique_ptr<ArtifactStore::Pin>> pins;
        for (const std::size_t size :
             {std::size_t{0}, std::size_t{1}, std::size_t{4096}, kMiB - 1, kMiB, kMiB + 1}) {
            contents.push_back(random_bytes(size, size + 1));
            pins.push_back(value(artifacts().put(contents.back())));
            EXPECT_EQ(pins.back()->digest(), sha256_hex(contents.back()));
            outcome.artifacts.push_back({std::to_string(size), pins.back()->digest()});
        }
        value(jobs().finish(claimed.lease, outcome));
    }
    between_steps();
    for (std::size_t i = 0; i < contents.size(); ++i) {
        const std::string digest = value(jobs().artifact("a", outcome.artifacts[i].name));
        EXPECT_EQ(value(artifacts().load(digest)), contents[i]);
        EXPECT_EQ(value(artifacts().open(digest))->size(), contents[i].size());
    }
}

TEST_P(ArtifactContract, RangesComeBack) {
    const std::string content = random_bytes(kMiB + 1, 5);
    const auto pin = value(artifacts().put(content));
    const auto reader = value(artifacts().open(pin->digest()));
    std::mt19937_64 random(6);
    for (int round = 0; round < 200; ++round) {
        const std::size_t offset = random() % (content.size() + 1);
        const std::size_t size = random() % (content.size() - offset + 1) >> (round % 20);
        std::string range(size, '\0');
        value(reader->read(offset, range));
        ASSERT_EQ(range, content.substr(offset, size)) << offset << " " << size;
    }
}

TEST_P(ArtifactContract, ARangePastTheEndIsCorrupt) {
    const auto pin = value(artifacts().put("0123456789"));
    const auto reader = value(artifacts().open(pin->digest()));
    std::string two(2, '\0');
    EXPECT_EQ(error_of(reader->read(9, two)), StoreErrorCode::kCorrupt);
    EXPECT_EQ(error_of(reader->read(1000, two)), StoreErrorCode::kCorrupt);
    value(reader->read(8, two));
    EXPECT_EQ(two, "89");
}

TEST_P(ArtifactContract, WhatWasNeverStoredIsNotFound) {
    for (const std::string& digest :
         {sha256_hex("never stored"),
          std::string(),
          std::string("a"),
          std::string("abc"),
          std::string("../../lock"),
          std::string("ab/cd/../../../../modelsynth.db")}) {
        EXPECT_EQ(error_of(artifacts().pin(digest)), StoreErrorCode::kNotFound) << digest;
        EXPECT_EQ(error_of(artifacts().open(digest)), StoreErrorCode::kNotFound) << digest;
        EXPECT_EQ(error_of(artifacts().load(digest)), StoreErrorCode::kNotFound) << digest;
    }
}

TEST_P(ArtifactContract, WhatNobodyPinsOrLinksGoes) {
    std::string digest;
    {
        const auto one = value(artifacts().put("content"));
        digest = one->digest();
        {
            const auto two = value(artifacts().put("content"));
            EXPECT_EQ(two->digest(), digest);
        }
        settle();
        EXPECT_EQ(value(artifacts().load(digest)), "content");
    }
    EXPECT_TRUE(eventually([&] { return !artifacts().open(digest); }));
    // It may come again.
    const auto again = value(artifacts().put("content"));
    settle();
    EXPECT_EQ(value(artifacts().load(digest)), "content");
}

TEST_P(ArtifactContract, ASecondPinKeepsWhatTheFirstOneLetsGo) {
    auto first = value(artifacts().put("content"));
    const std::string digest = first->digest();
    auto second = value(artifacts().pin(digest));
    EXPECT_EQ(second->digest(), digest);
    first.reset();
    settle();
    EXPECT_EQ(value(artifacts().load(digest)), "content");
    second.reset();
    EXPECT_TRUE(eventually([&] { return !artifacts().open(digest); }));
    EXPECT_EQ(error_of(artifacts().pin(digest)), StoreErrorCode::kNotFound);
}

TEST_P(ArtifactContract, AReaderKeepsItsBytesWhenTheArtifactGoes) {
    const std::string content = random_bytes(100'000, 7);
    auto pin = value(artifacts().put(content));
    const std::string digest = pin->digest();
    const auto reader = value(artifacts().open(digest));
    pin.reset();
    ASSERT_TRUE(eventually([&] { return !artifacts().open(digest); }));
    std::string all(reader->size(), '\0');
    value(reader->read(0, all));
    EXPECT_EQ(all, content);
}

TEST_P(ArtifactContract, APinKeepsWhatIsErasedOrExpires) {
    for (const bool is_erased : {true, false}) {
        const std::string id = is_erased ? "erased" : "expired";
        const auto pin = value(artifacts().put("content of " + id));
        const Claim claimed = submit_and_claim(id);
        value(jobs().finish(claimed.lease, succeeded({{"x", pin->digest()}})));
        if (is_erased) {
            value(jobs().erase(id));
        } else {
            jobs().expire(kNow + 3 + kRetentionMs);
        }
        settle();
        EXPECT_EQ(value(artifacts().load(pin->digest())), "content of " + id);
        // Linked anew it stays for good.
        const Claim next = submit_and_claim("next of " + id);
        Outcome outcome = succeeded({{"x", pin->digest()}});
        outcome.finished = kNow + 1000;
        value(jobs().finish(next.lease, outcome));
    }
    between_steps();
    settle();
    EXPECT_TRUE(artifacts().load(sha256_hex("content of erased")));
    EXPECT_TRUE(artifacts().load(sha256_hex("content of expired")));
}

TEST_P(ArtifactContract, TheSameBytesFromManyThreadsAreOneArtifact) {
    const std::string content = random_bytes(30'000, 8);
    const Claim claimed = submit_and_claim("a");
    {
        std::vector<std::unique_ptr<ArtifactStore::Pin>> pins(12);
        run_together(pins.size(), [&](std::size_t i) {
            pins[i] = value(artifacts().put(content));
            EXPECT_EQ(value(artifacts().load(pins[i]->digest())), content);
        });
        value(jobs().finish(claimed.lease, succeeded({{"x", pins.front()->digest()}})));
    }
    between_steps();
    settle();
    EXPECT_EQ(value(artifacts().load(sha256_hex(content))), content);
}

TEST_P(ArtifactContract, PutAndGoAtTheSameTimeLosesNothingThatIsPinned) {
    run_together(4, [&](std::size_t) {
        for (int round = 0; round < 10; ++round) {
            const auto pin = value(artifacts().put("comes and goes"));
            EXPECT_EQ(value(artifacts().load(pin->digest())), "comes and goes");
        }
    });
    EXPECT_TRUE(eventually([&] { return !artifacts().open(sha256_hex("comes and goes")); }));
}

TEST_P(ArtifactContract, WhatAJobIsSubmittedWithStaysWhenTheJobItCameFromGoes) {
    for (const bool is_erased : {true, false}) {
        const std::string first = is_erased ? "erased" : "expired";
        const std::string second = "from " + first;
        {
            const auto pin = value(artifacts().put("labels of " + first));
            const Claim claimed = submit_and_claim(first);
            value(jobs().finish(claimed.lease, succeeded({{"labels", pin->digest()}})));
        }
        const std::string digest = value(jobs().artifact(first, "labels"));
        NewJob job = new_job(second);
        job.artifacts = {{"origin", digest}};
        submit(job);
        between_steps();
        if (is_erased) {
            value(jobs().erase(first));
        } else {
            jobs().expire(kNow + 3 + kRetentionMs);
        }
        between_steps();
        settle();
        EXPECT_EQ(value(jobs().artifact(second, "origin")), digest);
        EXPECT_EQ(value(artifacts().load(digest)), "labels of " + first);
        // It outlives the claim, too, and goes with the job.
        const auto claimed = claim();
        ASSERT_TRUE(claimed && claimed->lease.job_id == second);
        value(jobs().finish(claimed->lease, failed()));
        between_steps();
        EXPECT_EQ(value(jobs().artifact(second, "origin")), digest);
        value(jobs().erase(second));
        EXPECT_TRUE(eventually([&] { return !artifacts().open(digest); }));
    }
}

TEST_P(ArtifactContract, LinkAndEraseAtTheSameTimeLeaveNoLinkWithoutItsFile) {
    constexpr int kRounds = 10;
    for (int round = 0; round < kRounds; ++round) {
        const std::string name = std::to_string(round);
        const Claim old = submit_and_claim("old" + name);
        const Claim fresh = submit_and_claim("new" + name);
        auto pin = value(artifacts().put("content " + name));
        const std::string digest = pin->digest();
        value(jobs().finish(old.lease, succeeded({{"x", digest}})));
        pin.reset();
        run_together(2, [&](std::size_t thread) {
            if (thread == 0) {
                value(jobs().erase("old" + name));
            } else {
                // Either it is there and stays, or it is refused.
                const auto finished = jobs().finish(fresh.lease, succeeded({{"x", digest}}));
                EXPECT_TRUE(finished || finished.error().code == StoreErrorCode::kConflict);
            }
        });
        settle();
        const auto linked = jobs().artifact("new" + name, "x");
        EXPECT_EQ(linked.has_value(), artifacts().load(digest).has_value());
    }
}

}  // namespace modelsynth::server
