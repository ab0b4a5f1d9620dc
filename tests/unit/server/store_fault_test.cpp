// What the embedded store says and keeps when the disk fails or the power goes.

#include "tests/unit/server/embedded_store.h"
#include "tests/unit/server/faulty_vfs.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>

namespace modelsynth::server {

namespace {

// What a run was told; what it was told must be so after every fault.
struct Told {
    std::vector<std::string> submitted;
    bool is_cancelled = false;
    std::optional<Lease> claimed;
    std::uint64_t head = 0;  // of the claimed job
    std::string labels;      // of its newest checkpoint
    bool is_finished = false;
    std::size_t failure_count = 0;

    template <class T>
    bool went_well(const Stored<T>& answer) {
        if (!answer) {
            ++failure_count;
            EXPECT_EQ(answer.error().code, StoreErrorCode::kUnavailable) << answer.error().message;
        }
        return answer.has_value();
    }
};

// Each call is made once, as if nobody tried again.
Told run_script(SqliteStore& store) {
    Told told;
    for (const char* id : {"a", "b"}) {
        if (told.went_well(store.submit(keyed_job(id, std::string("key of ") + id, id), {10}))) {
            told.submitted.emplace_back(id);
        }
    }
    told.is_cancelled = std::count(told.submitted.begin(), told.submitted.end(), "b") > 0 &&
                        told.went_well(store.cancel("b", kNow));
    const auto claimed = store.claim(kNow, {});
    if (!told.went_well(claimed) || !*claimed) {
        return told;
    }
    told.claimed = (*claimed)->lease;
    for (std::uint32_t block = 0; block < 3; ++block) {
        Progress progress = progress_of(block + 1);
        progress.checkpoint =
            JobCheckpoint{0, block + 1, std::to_string(block + 1), random_bytes(5000, block)};
        const auto first = append(store, *told.claimed, {block_event(block)}, progress);
        if (told.went_well(first)) {
            told.head = *first;
            told.labels = progress.checkpoint->labels;
        }
    }
    told.is_finished = told.went_well(store.finish(*told.claimed, failed()));
    return told;
}

void expect_kept(SqliteStore& store, const Told& told) {
    for (const std::string& id : told.submitted) {
        ASSERT_TRUE(store.find(id)) << id;
        EXPECT_EQ(value(store.find_key("", "key of " + id, id))->id, id);
    }
    if (told.is_cancelled) {
        EXPECT_EQ(value(store.find("b")).state, proto::JobState::kCancelled);
    }
    for (const proto::Job& job : value(store.list({})).jobs) {
        const std::vector<Event> log = whole_log(store, job.id);
        ASSERT_FALSE(log.empty());
        EXPECT_EQ(job.head, log.size());
        EXPECT_EQ(log.front().type, "queued");
        const auto terminal_count = std::count_if(log.begin(), log.end(), [](const Event& event) {
            return event.type == "failed" || event.type == "cancelled";
        });
        EXPECT_EQ(terminal_count, proto::is_ended(job.state) ? 1 : 0);
        if (proto::is_ended(job.state)) {
            EXPECT_EQ(log.back().type, proto::state_name(job.state));
        }
    }
    if (!told.claimed) {
        return;
    }
    const proto::Job job = value(store.find(told.claimed->job_id));
    EXPECT_GE(job.head, told.head);
    if (told.is_finished) {
        EXPECT_EQ(job.state, proto::JobState::kFailed);
    }
    if (const auto checkpoint = value(store.checkpoint(job.id)); !told.labels.empty()) {
        ASSERT_TRUE(checkpoint);
        EXPECT_GE(checkpoint->seq, told.head);
        EXPECT_LE(checkpoint->seq, job.head);
        EXPECT_EQ(checkpoint->labels, random_bytes(5000, checkpoint->blocks_done - 1));
    }
}

// Nothing is left of the fault: whatever state the jobs are in, they can be brought to an end.
void expect_usable(SqliteStore& store) {
    value(store.submit(new_job("after"), {10}));
    while (const auto claimed = value(store.claim(kNow, {}))) {
        value(append(store, claimed->lease, {block_event(9)}));
        value(store.finish(claimed->lease, failed()));
    }
    EXPECT_EQ(value(store.find("after")).state, proto::JobState::kFailed);
}

struct Fault {
    std::string name;
    FaultyVfs::Call call;
    int code;
    std::size_t count;
};

class StoreFaults : public testing::TestWithParam<Fault> {};

constexpr std::size_t kForLong = 1'000'000;

}  // namespace

TEST_P(StoreFaults, WhatWasAnsweredIsKeptWhicheverCallFails) {
    const Fault& fault = GetParam();
    std::size_t runs_with_failures = 0;
    for (std::size_t n = 1;; ++n) {
        SCOPED_TRACE(n);
        const TemporaryDirectory directory;
        FaultyVfs disk;
        Told told;
        {
            const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
            disk.fail(fault.call, n, fault.code, fault.count);
            told = run_script(*store);
            const bool has_failed = disk.has_failed();
            disk.heal();
            EXPECT_TRUE(has_failed || told.failure_count == 0);
            if (!has_failed) {
                EXPECT_TRUE(told.is_finished && told.is_cancelled);
                break;
            }
            runs_with_failures += told.failure_count > 0 ? 1 : 0;
            // The fault has gone, and nobody starts the service anew.
            expect_kept(*store, told);
            expect_usable(*store);
        }
        const auto reopened = value(SqliteStore::open(directory.path(), kRetentionMs));
        expect_kept(*reopened, told);
        EXPECT_EQ(value(reopened->find("after")).state, proto::JobState::kFailed);
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(runs_with_failures, fault.call == FaultyVfs::Call::kRead ? 0U : 5U);
}

TEST_P(StoreFaults, OpeningFailsWithAnErrorAndWorksOnceTheFaultHasGone) {
    const Fault& fault = GetParam();
    for (std::size_t n = 1;; ++n) {
        SCOPED_TRACE(n);
        const TemporaryDirectory directory;
        FaultyVfs disk;
        disk.fail(fault.call, n, fault.code, fault.count);
        const auto opened = SqliteStore::open(directory.path(), kRetentionMs);
        const bool has_failed = disk.has_failed();
        disk.heal();
        if (!opened) {
            EXPECT_EQ(error_of(opened), StoreErrorCode::kUnavailable);
            EXPECT_EQ(disk.open_file_count(), 0);
            const auto again = value(SqliteStore::open(directory.path(), kRetentionMs));
            expect_usable(*again);
        } else {
            expect_usable(**opened);
        }
        ASSERT_FALSE(HasFailure());
        if (!has_failed) {
            break;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Each,
    StoreFaults,
    testing::Values(
        Fault{"OneRead", FaultyVfs::Call::kRead, SQLITE_IOERR_READ, 1},
        Fault{"OneWrite", FaultyVfs::Call::kWrite, SQLITE_IOERR_WRITE, 1},
        Fault{"EveryWrite", FaultyVfs::Call::kWrite, SQLITE_IOERR_WRITE, kForLong},
        Fault{"FullDisk", FaultyVfs::Call::kWrite, SQLITE_FULL, kForLong},
        Fault{"OneSync", FaultyVfs::Call::kSync, SQLITE_IOERR_FSYNC, 1},
        Fault{"EverySync", FaultyVfs::Call::kSync, SQLITE_IOERR_FSYNC, kForLong}
    ),
    [](const auto& fault) { return fault.param.name; }
);

TEST(StorePowerLoss, WhatWasAnsweredIsThereWheneverThePowerGoes) {
    for (const std::uint64_t seed : {0U, 1U}) {
        bool has_failed = true;
        for (std::size_t n = 1; has_failed; ++n) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << " call " << n);
            const TemporaryDirectory directory;
            FaultyVfs disk;
            value(SqliteStore::open(directory.path(), kRetentionMs));
            disk.watch();
            Told told;
            {
                const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
                disk.cut_power_at(n);
                told = run_script(*store);
            }  // the log is moved into the database at the end, and that may be cut too
            has_failed = disk.has_failed();
            disk.restore_power(seed == 0 ? 0 : seed * 1000 + n);
            const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
            expect_kept(*store, told);
            expect_usable(*store);
            ASSERT_FALSE(HasFailure());
        }
    }
}

TEST(StoreDiskFaults, ALogThatCannotBeMovedAtTheEndLosesNothing) {
    for (const auto call :
         {FaultyVfs::Call::kWrite, FaultyVfs::Call::kSync, FaultyVfs::Call::kTruncate}) {
        const TemporaryDirectory directory;
        FaultyVfs disk;
        Told told;
        {
            const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
            told = run_script(*store);
            EXPECT_TRUE(told.is_finished);
            disk.fail(call, 1, SQLITE_IOERR, kForLong);
        }
        EXPECT_TRUE(disk.has_failed());
        EXPECT_EQ(disk.open_file_count(), 0);
        disk.heal();
        const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
        expect_kept(*store, told);
        expect_usable(*store);
    }
}

TEST(StoreDiskFaults, AJobThatCannotBeWrittenIsNotThere) {
    const TemporaryDirectory directory;
    FaultyVfs disk;
    const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
    value(store->submit(new_job("before"), {10}));
    disk.fail(FaultyVfs::Call::kWrite, 1, SQLITE_FULL, kForLong);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(
            error_of(store->submit(keyed_job("a", "key", "hash"), {10})),
            StoreErrorCode::kUnavailable
        );
        // What is there stays readable.
        EXPECT_EQ(error_of(store->find("a")), StoreErrorCode::kNotFound);
        EXPECT_TRUE(store->find("before"));
        EXPECT_EQ(whole_log(*store, "before").size(), 1U);
    }
    disk.heal();
    const Submitted submitted = value(store->submit(keyed_job("a", "key", "hash"), {10}));
    EXPECT_FALSE(submitted.replayed);
    EXPECT_EQ(submitted.job.queue_position, 1U);
}

TEST(StoreDiskFaults, ALogHasNoGapWhereAnAppendFailed) {
    const TemporaryDirectory directory;
    FaultyVfs disk;
    const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
    value(store->submit(new_job("a"), kNoLimit));
    const Lease lease = value(store->claim(kNow, {}))->lease;
    value(append(*store, lease, {block_event(0)}));
    disk.fail(FaultyVfs::Call::kWrite, 1, SQLITE_FULL, kForLong);
    EXPECT_EQ(error_of(append(*store, lease, {block_event(1)})), StoreErrorCode::kUnavailable);
    disk.heal();
    // The disk takes them again, but one is missing before them.
    EXPECT_EQ(error_of(append(*store, lease, {block_event(2)})), StoreErrorCode::kUnavailable);
    EXPECT_EQ(error_of(store->finish(lease, succeeded())), StoreErrorCode::kUnavailable);
    EXPECT_EQ(whole_log(*store, "a").size(), 2U);
    value(store->release(lease, 0));
    EXPECT_EQ(error_of(append(*store, lease, {block_event(2)})), StoreErrorCode::kLeaseLost);
    // Who takes it up again begins where the log ends.
    const Claim next = *value(store->claim(kNow, {}));
    EXPECT_EQ(next.head, 2U);
    value(append(*store, next.lease, {block_event(1)}));
    value(append(*store, next.lease, {block_event(2)}));
    value(store->finish(next.lease, succeeded()));
    EXPECT_EQ(whole_log(*store, "a").size(), 5U);
}

TEST(StoreDiskFaults, AFailureWhileLookingForFilesToRemoveEndsNothing) {
    for (std::size_t n = 1; n <= 12; ++n) {
        const TemporaryDirectory directory;
        FaultyVfs disk;
        const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
        auto pin = value(store->artifacts().put("content"));
        const std::string digest = pin->digest();
        disk.fail(FaultyVfs::Call::kRead, n, SQLITE_IOERR_READ, kForLong);
        pin.reset();
        store->expire(0);
        store->expire(0);
        disk.heal();
        expect_usable(*store);
        // It is looked for again.
        EXPECT_TRUE(eventually([&] { return !store->artifacts().open(digest); }));
    }
}

}  // namespace modelsynth::server
