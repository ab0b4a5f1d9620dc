// What only the embedded store has: its directory, its files, the form of its tables.

#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <fstream>

namespace modelsynth::server {

namespace {

namespace fs = std::filesystem;

class SqliteStoreFiles : public testing::Test {
  protected:
    [[nodiscard]] Stored<std::unique_ptr<SqliteStore>> open() const {
        return SqliteStore::open(directory_.path(), kRetentionMs);
    }

    // Runs SQL while no store has the directory.
    void execute(const std::string& sql) const {
        sqlite3* connection = nullptr;
        ASSERT_EQ(sqlite3_open(directory_.database().c_str(), &connection), SQLITE_OK);
        char* message = nullptr;
        EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK)
            << (message == nullptr ? "" : message);
        sqlite3_free(message);
        sqlite3_close(connection);
    }

    [[nodiscard]] std::vector<fs::path> files_in(const char* folder) const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(directory_.path() / folder)) {
            if (entry.is_regular_file()) {
                files.push_back(entry.path());
            }
        }
        return files;
    }

    [[nodiscard]] fs::path file_of(const std::string& digest) const {
        return directory_.path() / "artifacts" / digest.substr(0, 2) / digest.substr(2, 2) / digest;
    }

    // A succeeded job "a" with the content as its artifact "x".
    void keep(SqliteStore& store, const std::string& content) const {
        const auto pin = value(store.artifacts().put(content));
        value(store.submit(new_job("a"), kNoLimit));
        const auto claimed = value(store.claim(kNow, {}));
        value(store.finish(claimed->lease, succeeded({{"x", pin->digest()}})));
    }

    TemporaryDirectory directory_;
};

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

std::string read_text(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_F(SqliteStoreFiles, ASecondStoreOnTheDirectoryIsRefused) {
    auto first = value(open());
    const auto second = open();
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, StoreErrorCode::kConflict);
    EXPECT_NE(second.error().message.find("another process"), std::string::npos);
    value(first->submit(new_job("a"), kNoLimit));
    first.reset();
    EXPECT_TRUE(value(open())->find("a"));
}

TEST_F(SqliteStoreFiles, ADirectoryThatCannotBeMadeIsAnError) {
    write_text(directory_.path() / "file", "");
    const auto opened = SqliteStore::open(directory_.path() / "file" / "below", kRetentionMs);
    EXPECT_EQ(error_of(opened), StoreErrorCode::kUnavailable);
}

TEST_F(SqliteStoreFiles, TablesOfANewerFormAreRefused) {
    value(value(open())->submit(new_job("a"), kNoLimit));
    execute("UPDATE meta SET value = 7 WHERE key = 'schema'");
    for (int i = 0; i < 2; ++i) {
        const auto opened = open();
        ASSERT_FALSE(opened);
        EXPECT_EQ(opened.error().code, StoreErrorCode::kConflict);
        EXPECT_NE(opened.error().message.find("newer version"), std::string::npos);
        EXPECT_NE(opened.error().message.find("form 7"), std::string::npos);
    }
    // Nothing was changed in it.
    execute("UPDATE meta SET value = 6 WHERE key = 'schema'");
    EXPECT_TRUE(value(open())->find("a"));
}

// From the newest form back to the fourth, which knew no webhooks.
constexpr const char* kUndoFifthForm =
    "DROP TABLE delivery; ALTER TABLE job DROP COLUMN webhook;"
    "UPDATE meta SET value = 4 WHERE key = 'schema';";

// From there back to the third, which knew no owners.
constexpr const char* kUndoFourthForm =
    "DROP INDEX job_key; DROP INDEX job_queue; DROP INDEX job_running; DROP INDEX job_owner;"
    "DROP TABLE flow; DROP TABLE example_owner; DELETE FROM meta WHERE key = 'turn';"
    "ALTER TABLE job DROP COLUMN owner; ALTER TABLE job DROP COLUMN traceparent;"
    "ALTER TABLE job DROP COLUMN cost; ALTER TABLE job DROP COLUMN memory_bytes;"
    "ALTER TABLE job DROP COLUMN turn;"
    "CREATE UNIQUE INDEX job_key ON job (idempotency_key) WHERE idempotency_key IS NOT NULL;"
    "CREATE INDEX job_queue ON job (ordinal) WHERE state = 0;"
    "CREATE INDEX job_running ON job (ordinal) WHERE state = 1;"
    "UPDATE meta SET value = 3 WHERE key = 'schema';";

TEST_F(SqliteStoreFiles, DeliveriesOfTheFifthFormAreTheirJobsOwners) {
    NewJob job = new_job("a");
    job.webhook = "https://example.com/hook";
    job.owner = "ann";
    {
        const auto store = value(open());
        value(store->submit(job, kNoLimit));
        value(store->cancel("a", kNow));
    }
    execute(
        "DROP INDEX delivery_owner; ALTER TABLE delivery DROP COLUMN owner;"
        "UPDATE meta SET value = 5 WHERE key = 'schema'"
    );
    const auto store = value(open());
    EXPECT_EQ(value(store->due_deliveries(kNow, 1, 10)).items.size(), 1U);
    QueueLimits limits = kNoLimit;
    limits.deliveries_max = 1;
    job.id = "b";
    EXPECT_EQ(error_of(store->submit(job, limits)), StoreErrorCode::kWebhooksFull);
    job.owner = "bob";
    EXPECT_FALSE(error_of(store->submit(job, limits)));
}

TEST_F(SqliteStoreFiles, JobsOfTheFourthFormHaveNoWebhooks) {
    value(value(open())->submit(new_job("a"), kNoLimit));
    execute(kUndoFifthForm);
    const auto store = value(open());
    value(store->cancel("a", kNow));
    EXPECT_TRUE(value(store->due_deliveries(kNow, 1, 10)).items.empty());
    NewJob job = new_job("b");
    job.webhook = "https://example.com/hook";
    value(store->submit(job, kNoLimit));
    value(store->cancel("b", kNow));
    EXPECT_EQ(value(store->due_deliveries(kNow, 1, 10)).items.size(), 1U);
}

TEST_F(SqliteStoreFiles, TablesOfTheThirdFormAreNobodys) {
    {
        const auto store = value(open());
        value(store->submit(keyed_job("a", "key", "hash"), kNoLimit));
        value(store->submit(new_job("b"), kNoLimit));
        const auto pin = value(store->artifacts().put("text"));
        value(store->add_example({"x", "", pin->digest()}, "", 10));
    }
    execute(kUndoFifthForm);
    execute(kUndoFourthForm);
    const auto store = value(open());
    EXPECT_EQ(value(store->find_key("", "key", "hash"))->id, "a");
    EXPECT_TRUE(store->find_example("x", ""));
    EXPECT_EQ(value(store->find("b")).owner, "");
    EXPECT_EQ(value(store->claim(kNow, {}))->lease.job_id, "a");
    EXPECT_EQ(value(store->claim(kNow, {}))->lease.job_id, "b");
}

TEST_F(SqliteStoreFiles, TablesOfTheFirstFormAreBroughtForward) {
    {
        const auto store = value(open());
        keep(*store, "content");
        value(store->submit(new_job("b"), kNoLimit));
        value(append(*store, value(store->claim(kNow, {}))->lease, {block_event(0)}));
    }
    execute(kUndoFifthForm);
    execute(kUndoFourthForm);
    execute(
        "ALTER TABLE job DROP COLUMN version_base; DROP TABLE checkpoint;"
        "UPDATE meta SET value = 1 WHERE key = 'schema'"
    );
    {
        const auto store = value(open());
        EXPECT_EQ(value(store->find("a")).state, proto::JobState::kSucceeded);
        EXPECT_EQ(value(store->artifacts().load(value(store->artifact("a", "x")))), "content");
        EXPECT_EQ(whole_log(*store, "b").size(), 2U);
        const auto claimed = value(store->claim(kNow, {}));
        ASSERT_TRUE(claimed);
        EXPECT_EQ(claimed->job.blocks_done, 1U);
        EXPECT_EQ(claimed->version_base, 0U);
        EXPECT_FALSE(claimed->checkpoint);
        Progress progress = progress_of(2);
        progress.checkpoint = JobCheckpoint{0, 2, "2", "labels"};
        value(append(*store, claimed->lease, {block_event(1)}, progress));
    }
    EXPECT_EQ(value(value(open())->checkpoint("b"))->seq, 3U);
}

TEST_F(SqliteStoreFiles, TablesOfTheSecondFormKeepTheirCheckpoints) {
    {
        const auto store = value(open());
        value(store->submit(new_job("a"), kNoLimit));
        Progress progress = progress_of(1);
        progress.checkpoint = JobCheckpoint{0, 1, "1", "labels"};
        value(append(*store, value(store->claim(kNow, {}))->lease, {block_event(0)}, progress));
    }
    execute(kUndoFifthForm);
    execute(kUndoFourthForm);
    execute(
        "ALTER TABLE job DROP COLUMN version_base; ALTER TABLE checkpoint DROP COLUMN tally;"
        "ALTER TABLE checkpoint ADD COLUMN blocks_accepted INTEGER NOT NULL DEFAULT 1;"
        "UPDATE meta SET value = 2 WHERE key = 'schema'"
    );
    const auto claimed = value(value(open())->claim(kNow, {}));
    ASSERT_TRUE(claimed && claimed->checkpoint);
    EXPECT_EQ(claimed->checkpoint->labels, "labels");
    EXPECT_EQ(claimed->checkpoint->tally, "");  // older solvers counted in another way
    EXPECT_EQ(claimed->version_base, 0U);
}

TEST_F(SqliteStoreFiles, ADatabaseThatIsNoneIsRefused) {
    for (const std::string& garbage :
         {random_bytes(100'000, 9), std::string(5000, '\0'), std::string("SQLite format 3")}) {
        write_text(directory_.database(), garbage);
        const auto opened = open();
        EXPECT_EQ(error_of(opened), StoreErrorCode::kUnavailable) << garbage.size();
        EXPECT_TRUE(read_text(directory_.database()) == garbage);  // not made anew over it
    }
    fs::remove(directory_.database());
    EXPECT_TRUE(open());
}

TEST_F(SqliteStoreFiles, ADamagedDatabaseIsRefused) {
    {
        const auto store = value(open());
        for (int i = 0; i < 50; ++i) {
            value(store->submit(new_job("job" + std::to_string(i)), kNoLimit));
        }
    }
    std::string bytes = read_text(directory_.database());
    ASSERT_GT(bytes.size(), std::size_t{5} * 4096);
    const std::string noise = random_bytes(bytes.size() - 4096, 10);
    bytes.replace(4096, noise.size(), noise);  // all but the first page
    write_text(directory_.database(), bytes);
    const auto opened = open();
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, StoreErrorCode::kUnavailable);
    EXPECT_FALSE(opened.error().message.empty());
}

TEST_F(SqliteStoreFiles, AnEmptyDatabaseDoesNotTakeTheArtifactsAway) {
    keep(*value(open()), "content");
    const auto files = [this] {
        std::size_t count = 0;
        for (const auto& entry :
             fs::recursive_directory_iterator(directory_.path() / "artifacts")) {
            count += entry.is_regular_file() ? 1U : 0U;
        }
        return count;
    };
    ASSERT_EQ(files(), 1U);
    fs::rename(directory_.path() / "modelsynth.db", directory_.path() / "lost.db");
    for (int i = 0; i < 2; ++i) {
        const auto opened = open();
        ASSERT_FALSE(opened);
        EXPECT_EQ(opened.error().code, StoreErrorCode::kUnavailable);
        EXPECT_NE(opened.error().message.find("there are artifacts"), std::string::npos);
        EXPECT_EQ(files(), 1U);
    }
    fs::rename(directory_.path() / "lost.db", directory_.path() / "modelsynth.db");
    const auto store = value(open());
    EXPECT_EQ(value(store->artifacts().load(value(store->artifact("a", "x")))), "content");
}

TEST_F(SqliteStoreFiles, TheSameBytesAreOneFile) {
    const auto store = value(open());
    std::vector<std::unique_ptr<ArtifactStore::Pin>> pins(16);
    run_together(pins.size(), [&](std::size_t i) {
        pins[i] = value(store->artifacts().put(i % 2 == 0 ? "even" : "odd"));
    });
    pins.push_back(value(store->artifacts().put("even")));
    EXPECT_EQ(files_in("artifacts").size(), 2U);
    EXPECT_TRUE(files_in("tmp").empty());
    EXPECT_EQ(read_text(file_of(sha256_hex("odd"))), "odd");
    pins.clear();
    EXPECT_TRUE(eventually([this] { return files_in("artifacts").empty(); }));
}

TEST_F(SqliteStoreFiles, AFlippedBitIsFoundWhenAnArtifactIsLoaded) {
    const std::string content = random_bytes(50'000, 11);
    const std::string digest = sha256_hex(content);
    keep(*value(open()), content);
    const auto store = value(open());
    for (const std::size_t at : {std::size_t{0}, content.size() / 2, content.size() - 1}) {
        std::string flipped = content;
        flipped[at] = static_cast<char>(flipped[at] ^ 4);
        write_text(file_of(digest), flipped);
        EXPECT_EQ(error_of(store->artifacts().load(digest)), StoreErrorCode::kCorrupt) << at;
    }
    write_text(file_of(digest), content.substr(1));
    EXPECT_EQ(error_of(store->artifacts().load(digest)), StoreErrorCode::kCorrupt);
    write_text(file_of(digest), content);
    EXPECT_EQ(value(store->artifacts().load(digest)), content);
    fs::remove(file_of(digest));
    EXPECT_EQ(error_of(store->artifacts().load(digest)), StoreErrorCode::kNotFound);
}

TEST_F(SqliteStoreFiles, AFileThatShrinksUnderItsReaderIsCorrupt) {
    const std::string content = random_bytes(50'000, 12);
    const auto store = value(open());
    keep(*store, content);
    const auto reader = value(store->artifacts().open(sha256_hex(content)));
    fs::resize_file(file_of(sha256_hex(content)), 20'000);
    std::string all(reader->size(), '\0');
    EXPECT_EQ(error_of(reader->read(0, all)), StoreErrorCode::kCorrupt);
}

TEST_F(SqliteStoreFiles, WhatACrashLeavesInFilesIsSweptWhenTheStoreOpens) {
    keep(*value(open()), "kept");
    write_text(directory_.path() / "tmp" / "0", "torn");
    fs::create_directories(directory_.path() / "tmp" / "deeper");
    write_text(directory_.path() / "tmp" / "deeper" / "1", "torn");
    const std::string orphan = sha256_hex("orphan");
    fs::create_directories(file_of(orphan).parent_path());
    write_text(file_of(orphan), "orphan");
    const auto store = value(open());
    EXPECT_TRUE(fs::is_empty(directory_.path() / "tmp"));
    EXPECT_EQ(files_in("artifacts"), std::vector<fs::path>{file_of(sha256_hex("kept"))});
    EXPECT_EQ(value(store->artifacts().load(sha256_hex("kept"))), "kept");
}

TEST_F(SqliteStoreFiles, AnArtifactThatCannotBeWrittenIsUnavailable) {
    const auto store = value(open());
    fs::remove_all(directory_.path() / "tmp");
    EXPECT_EQ(error_of(store->artifacts().put("x")), StoreErrorCode::kUnavailable);
    fs::create_directories(directory_.path() / "tmp");
    EXPECT_TRUE(store->artifacts().put("x"));
}

TEST_F(SqliteStoreFiles, AJobOfAnEarlierTimeExpiresByTheRetentionItEndedUnder) {
    keep(*value(open()), "content");
    const auto store = value(SqliteStore::open(directory_.path(), 7 * kRetentionMs));
    EXPECT_EQ(value(store->find("a")).expires, kNow + 2 + kRetentionMs);
}

}  // namespace modelsynth::server
