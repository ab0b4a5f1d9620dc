#pragma once

#include "server/store/artifact_store.h"
#include "server/store/delivery_store.h"
#include "server/store/event_log.h"
#include "server/store/job_store.h"
#include "server/store/sqlite/database.h"
#include "server/store/sqlite/file_artifacts.h"
#include "server/store/sqlite/waiting_appends.h"
#include "server/store/sqlite/writer.h"

#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace modelsynth::server {

// The embedded store: a directory with a SQLite database (WAL, FULL) and artifact files.
//
//   DIR/lock            held while a process uses the directory; a second one is refused
//   DIR/modelsynth.db   jobs, events, links, examples
//   DIR/artifacts/      files by SHA-256
//   DIR/tmp/            files being written; emptied at the start
class SqliteStore final : public JobStore,
                          public EventLog,
                          public ExampleStore,
                          public DeliveryStore {
  public:
    // Opens or makes the store and takes back what a crash left: jobs that were running are
    // queued again, unreferenced files are removed. Fails: kUnavailable, kConflict when another
    // process has it or a newer version wrote it.
    // Ended jobs expire after `retention_ms`.
    [[nodiscard]] static Stored<std::unique_ptr<SqliteStore>> open(
        const std::filesystem::path& directory, proto::UnixMillis retention_ms
    );

    ~SqliteStore() override;

    [[nodiscard]] ArtifactStore& artifacts() { return *artifacts_; }

    // Told, on the store's thread, how long each commit took. Set before the first call.
    void on_commit(std::function<void(double seconds)> told) {
        writer_->on_commit(std::move(told));
    }

    // JobStore
    [[nodiscard]] Stored<Submitted> submit(const NewJob& job, const QueueLimits& limits) override;
    [[nodiscard]] Stored<std::optional<proto::Job>> find_key(
        const std::string& owner,
        const std::string& idempotency_key,
        const std::string& request_hash
    ) override;
    [[nodiscard]] Stored<proto::Job> find(const std::string& id) override;
    [[nodiscard]] Stored<JobPage> list(const JobQuery& query) override;
    [[nodiscard]] Stored<std::size_t> queued_count() override;
    [[nodiscard]] Stored<std::optional<Claim>> claim(
        proto::UnixMillis now, const ClaimLimits& limits
    ) override;
    void append(
        const Lease& lease,
        std::vector<NewEvent> events,
        const Progress& progress,
        std::function<void(const Stored<std::uint64_t>&)> done
    ) override;
    [[nodiscard]] Stored<proto::Job> finish(const Lease& lease, const Outcome& outcome) override;
    [[nodiscard]] Stored<void> release(const Lease& lease, double solved_seconds) override;
    [[nodiscard]] Stored<proto::Job> cancel(const std::string& id, proto::UnixMillis now) override;
    [[nodiscard]] Stored<void> erase(const std::string& id) override;
    [[nodiscard]] Stored<std::string> artifact(const std::string& id, const std::string& name)
        override;
    [[nodiscard]] Stored<std::optional<JobCheckpoint>> checkpoint(const std::string& id) override;
    [[nodiscard]] Stored<void> link(const std::string& id, const ArtifactLink& link) override;
    void expire(proto::UnixMillis now) override;
    void forget(proto::UnixMillis then) override;
    void shed(std::uint64_t bytes_max, proto::UnixMillis now) override;

    // EventLog
    [[nodiscard]] Stored<EventPage> read(
        const std::string& job_id, std::uint64_t after, std::size_t limit
    ) override;
    [[nodiscard]] std::unique_ptr<Subscription> subscribe(
        const std::string& job_id, News news, std::function<void()> changed
    ) override;

    // ExampleStore
    [[nodiscard]] Stored<void> add_example(
        const Row& row, const std::string& owner, std::size_t count_max
    ) override;
    [[nodiscard]] Stored<Row> find_example(const std::string& id, const OwnerFilter& owner)
        override;
    [[nodiscard]] Stored<std::vector<Row>> list_examples(const OwnerFilter& owner) override;
    [[nodiscard]] Stored<void> erase_example(const std::string& id, const OwnerFilter& owner)
        override;

    // DeliveryStore
    [[nodiscard]] Stored<DueDeliveries> due_deliveries(
        proto::UnixMillis now, std::size_t per_receiver_max, std::size_t limit
    ) override;
    [[nodiscard]] Stored<std::size_t> delivery_count() override;
    [[nodiscard]] Stored<void> postpone_delivery(
        const std::string& job_id, std::uint32_t tries, proto::UnixMillis due
    ) override;
    [[nodiscard]] Stored<void> drop_delivery(const std::string& job_id) override;
    void on_delivery(std::function<void()> told) override;

  private:
    class Listener;
    using ListenerMap = std::multimap<std::string, Listener*>;

    SqliteStore(const std::filesystem::path& directory, int lock, proto::UnixMillis retention_ms);

    void recover(Database& database);
    void after_commit(Database& database);
    void tell_listeners(const std::map<std::string, News>& jobs);
    // That listeners are to be told of the job.
    void touch(const std::string& id, News news);

    // Takes what an ended job has left but its row and events.
    void take_artifacts(Database& database, const std::string& id);
    void end_cancelled(Database& database, const std::string& id, proto::UnixMillis now);
    // What the webhook of a job that has just ended is to be sent, if it has one.
    void add_delivery(Database& database, const std::string& id, proto::UnixMillis now);
    void append_event(Database& database, const std::string& id, const NewEvent& event);
    // Fails: as append().
    Stored<void> append_now(Database& database, WaitingAppends::Batch& batch);
    // An append failed with that.
    void note_gap(const Lease& lease, StoreErrorCode code);
    [[nodiscard]] bool has_gap(const Lease& lease) const;
    // With a number that the caller counts on from.
    void insert_event(
        Database& database, const std::string& id, std::uint64_t seq, const NewEvent& event
    );
    // Everything, or what was made and not what the job works on.
    enum class Unlinked : std::uint8_t { kAll, kMade };
    void unlink_artifacts(Database& database, const std::string& id, Unlinked which);
    Stored<void> link_artifacts(
        Database& database, const std::string& id, const std::vector<ArtifactLink>& artifacts
    );

    // Runs a read on a connection of its own.
    template <class T>
    Stored<T> with_reader(const std::function<Stored<T>(Database&)>& read) {
        try {
            std::unique_ptr<Database> reader;
            {
                const std::lock_guard lock(readers_mutex_);
                if (!idle_readers_.empty()) {
                    reader = std::move(idle_readers_.back());
                    idle_readers_.pop_back();
                }
            }
            if (!reader) {
                reader = std::make_unique<Database>(path_, Database::Mode::kReader);
            }
            // One snapshot for all statements of the read.
            reader->prepare("BEGIN").run();
            Stored<T> result = read(*reader);
            reader->prepare("COMMIT").run();
            const std::lock_guard lock(readers_mutex_);
            idle_readers_.push_back(std::move(reader));
            return result;
        } catch (const SqliteError& error) {
            return tl::unexpected(StoreError{StoreErrorCode::kUnavailable, error.what()});
        }
    }

    std::string path_;
    int lock_;
    proto::UnixMillis retention_ms_;
    std::unique_ptr<FileArtifacts> artifacts_;

    // Only the writer's thread uses these.
    std::map<std::string, News> touched_;        // jobs whose listeners are told after the commit
    std::vector<std::string> unlinked_digests_;  // files to look at after the commit
    bool has_new_deliveries_ = false;            // told of after the commit
    // Jobs with the token of a lease that one of its appends failed for.
    std::map<std::string, std::uint64_t> gaps_;

    std::mutex readers_mutex_;
    std::vector<std::unique_ptr<Database>> idle_readers_;

    std::mutex listeners_mutex_;
    ListenerMap listeners_;
    std::function<void()> on_delivery_;  // guarded by listeners_mutex_

    WaitingAppends waiting_appends_;

    std::unique_ptr<Writer> writer_;  // last: its thread uses all of the above
};

}  // namespace modelsynth::server
