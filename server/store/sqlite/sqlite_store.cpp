#include "server/store/sqlite/sqlite_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <limits>
#include <utility>

namespace modelsynth::server {

namespace {

using proto::Job;
using proto::JobState;
using proto::UnixMillis;

constexpr int kSchemaVersion = 1;

// A job that waited this long counts as one priority level higher, so that none starves.
constexpr const char* kEffectivePriority = "(priority + (?1 - created) / 30000)";

constexpr const char* kSchema = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value INTEGER NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE job (
    ordinal INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE,
    solver TEXT NOT NULL,
    seed INTEGER NOT NULL,
    priority INTEGER NOT NULL,
    request TEXT NOT NULL,
    example_id TEXT NOT NULL,
    request_hash TEXT NOT NULL,
    idempotency_key TEXT,
    state INTEGER NOT NULL,
    cancel_requested INTEGER NOT NULL DEFAULT 0,
    next_seq INTEGER NOT NULL DEFAULT 1,
    blocks_done INTEGER NOT NULL DEFAULT 0,
    blocks_total INTEGER NOT NULL DEFAULT 0,
    solver_version TEXT NOT NULL DEFAULT '',
    solved_seconds REAL NOT NULL DEFAULT 0,
    deadline REAL,
    token INTEGER NOT NULL DEFAULT 0,
    fruitless_claims INTEGER NOT NULL DEFAULT 0,
    created INTEGER NOT NULL,
    started INTEGER,
    finished INTEGER,
    expires INTEGER,
    result TEXT NOT NULL DEFAULT '',
    error TEXT NOT NULL DEFAULT ''
) STRICT;
CREATE UNIQUE INDEX job_key ON job (idempotency_key) WHERE idempotency_key IS NOT NULL;
CREATE INDEX job_queue ON job (ordinal) WHERE state = 0;
CREATE INDEX job_running ON job (ordinal) WHERE state = 1;
CREATE INDEX job_expiry ON job (expires) WHERE expires IS NOT NULL;
CREATE TABLE event (
    job_id TEXT NOT NULL REFERENCES job (id) ON DELETE CASCADE,
    seq INTEGER NOT NULL,
    type TEXT NOT NULL,
    time INTEGER NOT NULL,
    fields TEXT NOT NULL,
    PRIMARY KEY (job_id, seq)
) STRICT, WITHOUT ROWID;
CREATE TABLE job_artifact (
    job_id TEXT NOT NULL REFERENCES job (id) ON DELETE CASCADE,
    name TEXT NOT NULL,
    digest TEXT NOT NULL,
    PRIMARY KEY (job_id, name)
) STRICT, WITHOUT ROWID;
CREATE INDEX job_artifact_digest ON job_artifact (digest);
CREATE TABLE example (
    id TEXT PRIMARY KEY,
    name TEXT NOT NULL,
    digest TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE INDEX example_digest ON example (digest);
)sql";

constexpr const char* kJobColumns =
    "id, state, solver, seed, created, started, finished, expires, blocks_done, blocks_total, "
    "request, result, error, ordinal, next_seq";

tl::unexpected<StoreError> failure(StoreErrorCode code, std::string message) {
    return tl::unexpected(StoreError{code, std::move(message)});
}

tl::unexpected<StoreError> no_job(const std::string& id) {
    return failure(StoreErrorCode::kNotFound, "there is no job " + id);
}

std::optional<UnixMillis> optional_time(const Statement& row, int column) {
    return row.is_null(column) ? std::nullopt : std::optional(row.integer(column));
}

Job job_of(const Statement& row) {
    Job job;
    job.id = row.text(0);
    job.state = static_cast<JobState>(row.integer(1));
    job.solver = row.text(2);
    job.seed = row.natural(3);
    job.created = row.integer(4);
    job.started = optional_time(row, 5);
    job.finished = optional_time(row, 6);
    job.expires = optional_time(row, 7);
    job.blocks_done = static_cast<std::uint32_t>(row.natural(8));
    job.blocks_total = static_cast<std::uint32_t>(row.natural(9));
    job.request = row.text(10);
    job.result = row.text(11);
    job.error = row.text(12);
    job.head = row.natural(14) - 1;
    return job;
}

// How many queued jobs go before this one, by the order of claim().
std::uint64_t queue_position(Database& database, const std::string& id, UnixMillis now) {
    const std::string effective = kEffectivePriority;
    Statement own =
        database.prepare("SELECT " + effective + ", ordinal FROM job WHERE id = ?2 AND state = 0");
    own.bind(now).bind(std::string_view(id));
    if (!own.step()) {
        return 0;
    }
    Statement before = database.prepare(
        "SELECT COUNT(*) FROM job WHERE state = 0 AND (" + effective + " > ?2 OR (" + effective +
        " = ?2 AND ordinal < ?3))"
    );
    before.bind(now).bind(own.integer(0)).bind(own.integer(1));
    before.step();
    return before.natural(0);
}

UnixMillis now_millis() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch()
    )
        .count();
}

Stored<Job> find_job(Database& database, const std::string& id) {
    Statement row =
        database.prepare(std::string("SELECT ") + kJobColumns + " FROM job WHERE id = ?");
    row.bind(std::string_view(id));
    if (!row.step()) {
        return no_job(id);
    }
    Job job = job_of(row);
    if (job.state == JobState::kQueued) {
        job.queue_position = queue_position(database, id, now_millis());
    }
    return job;
}

// The job of an idempotency key, or nothing; a conflict when the key was used for another request.
Stored<std::optional<Job>> job_of_key(
    Database& database, const std::string& key, const std::string& request_hash
) {
    std::string id;
    {
        Statement known =
            database.prepare("SELECT id, request_hash FROM job WHERE idempotency_key = ?");
        known.bind(std::string_view(key));
        if (!known.step()) {
            return std::optional<Job>();
        }
        if (known.text(1) != request_hash) {
            return failure(StoreErrorCode::kConflict, "the key was used for another request");
        }
        id = known.text(0);
    }
    auto job = find_job(database, id);
    if (!job) {
        return tl::unexpected(std::move(job.error()));
    }
    return std::optional<Job>(std::move(*job));
}

// Whether the lease still holds the job.
bool holds(Database& database, const Lease& lease) {
    Statement row = database.prepare("SELECT token, state FROM job WHERE id = ?");
    row.bind(std::string_view(lease.job_id));
    return row.step() && row.natural(0) == lease.token &&
           static_cast<JobState>(row.integer(1)) == JobState::kRunning;
}

tl::unexpected<StoreError> lease_lost(const Lease& lease) {
    return failure(StoreErrorCode::kLeaseLost, "job " + lease.job_id + " has another holder");
}

bool is_digest_used(Database& database, const std::string& digest) {
    Statement row = database.prepare(
        "SELECT EXISTS (SELECT 1 FROM job_artifact WHERE digest = ?1) OR "
        "EXISTS (SELECT 1 FROM example WHERE digest = ?1)"
    );
    row.bind(std::string_view(digest));
    return row.step() && row.integer(0) != 0;
}

}  // namespace

// Registers itself; both ends hold the store's mutex, so that a callback is never running when
// the destructor returns.
class SqliteStore::Listener final : public EventLog::Subscription {
  public:
    Listener(SqliteStore& store, const std::string& job_id, std::function<void()> changed)
        : store_(store), changed_(std::move(changed)) {
        const std::lock_guard lock(store_.listeners_mutex_);
        place_ = store_.listeners_.emplace(job_id, this);
    }

    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    ~Listener() override {
        const std::lock_guard lock(store_.listeners_mutex_);
        store_.listeners_.erase(place_);
    }

    void tell() const { changed_(); }

  private:
    SqliteStore& store_;
    std::function<void()> changed_;
    ListenerMap::iterator place_;
};

Stored<std::unique_ptr<SqliteStore>> SqliteStore::open(
    const std::filesystem::path& directory, UnixMillis retention_ms
) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    const int lock = ::open((directory / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
    if (lock < 0) {
        return failure(
            StoreErrorCode::kUnavailable, "the directory " + directory.string() + " cannot be used"
        );
    }
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        ::close(lock);
        return failure(
            StoreErrorCode::kConflict, "another process uses the directory " + directory.string()
        );
    }
    try {
        // The destructor gives the lock back from here on.
        auto store = std::unique_ptr<SqliteStore>(new SqliteStore(directory, lock, retention_ms));
        return store;
    } catch (const std::exception& problem) {
        ::close(lock);
        return failure(StoreErrorCode::kUnavailable, problem.what());
    }
}

SqliteStore::SqliteStore(const std::filesystem::path& directory, int lock, UnixMillis retention_ms)
    : path_((directory / "modelsynth.db").string()),
      lock_(lock),
      retention_ms_(retention_ms),
      artifacts_(std::make_unique<FileArtifacts>(directory / "artifacts", directory / "tmp")) {
    {
        Database database(path_, Database::Mode::kWriter);
        prepare_schema(database);
        recover(database);
        artifacts_->sweep([&database](const std::string& digest) {
            return is_digest_used(database, digest);
        });
    }
    touched_.clear();
    writer_ = std::make_unique<Writer>(path_);
    // What was put and never linked, because the job was deleted meanwhile say, goes when the last
    // pin does.
    artifacts_->on_unpinned([this](const std::string& digest) {
        writer_->post(
            {[this, digest](Database&) -> Stored<void> {
                 unlinked_digests_.push_back(digest);
                 return {};
             },
             [](const Stored<void>&) {}}
        );
    });
    writer_->after_commit([this](Database& database) { after_commit(database); });
}

SqliteStore::~SqliteStore() {
    {
        const std::lock_guard lock(readers_mutex_);
        idle_readers_.clear();  // readers close before the writer
    }
    writer_->close();
    ::close(lock_);
}

void SqliteStore::prepare_schema(Database& database) {
    {
        Statement check = database.prepare("PRAGMA quick_check(1)");
        if (!check.step() || check.text(0) != "ok") {
            throw SqliteError("the database is damaged: " + check.text(0));
        }
    }
    bool is_new = false;
    {
        Statement meta = database.prepare("SELECT COUNT(*) FROM sqlite_schema WHERE name = 'meta'");
        meta.step();
        is_new = meta.integer(0) == 0;
    }
    if (is_new) {
        database.execute("BEGIN IMMEDIATE");
        database.execute(kSchema);
        database.prepare("INSERT INTO meta VALUES ('schema', ?)")
            .bind(std::int64_t{kSchemaVersion})
            .run();
        database.execute("COMMIT");
    }
    Statement version = database.prepare("SELECT value FROM meta WHERE key = 'schema'");
    if (!version.step() || version.integer(0) != kSchemaVersion) {
        throw SqliteError("the database was made by another version of the program");
    }
}

void SqliteStore::recover(Database& database) {
    database.execute("BEGIN IMMEDIATE");
    std::vector<std::string> cancelled;
    {
        Statement rows =
            database.prepare("SELECT id FROM job WHERE state = 1 AND cancel_requested = 1");
        while (rows.step()) {
            cancelled.push_back(rows.text(0));
        }
    }
    for (const std::string& id : cancelled) {
        const UnixMillis now = now_millis();
        end_cancelled(database, id, now);
    }
    // One process: whoever held a lease is gone.
    database.execute(
        "UPDATE job SET state = 0, fruitless_claims = fruitless_claims + 1 WHERE state = 1"
    );
    database.execute("COMMIT");
}

void SqliteStore::after_commit(Database& database) {
    for (const std::string& digest : std::exchange(unlinked_digests_, {})) {
        if (!is_digest_used(database, digest)) {
            artifacts_->remove_if_unpinned(digest);
        }
    }
    const std::set<std::string> touched = std::exchange(touched_, {});
    const std::lock_guard lock(listeners_mutex_);
    for (const std::string& id : touched) {
        const auto [first, last] = listeners_.equal_range(id);
        for (auto listener = first; listener != last; ++listener) {
            listener->second->tell();
        }
    }
}

template <class T>
Stored<T> SqliteStore::with_reader(const std::function<Stored<T>(Database&)>& read) {
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
        reader->execute("BEGIN");
        Stored<T> result = read(*reader);
        reader->execute("COMMIT");
        const std::lock_guard lock(readers_mutex_);
        idle_readers_.push_back(std::move(reader));
        return result;
    } catch (const SqliteError& error) {
        return failure(StoreErrorCode::kUnavailable, error.what());
    }
}

void SqliteStore::append_event(Database& database, const std::string& id, const NewEvent& event) {
    database
        .prepare(
            "INSERT INTO event (job_id, seq, type, time, fields) "
            "SELECT id, next_seq, ?2, ?3, ?4 FROM job WHERE id = ?1"
        )
        .bind(std::string_view(id))
        .bind(std::string_view(event.type))
        .bind(event.time)
        .bind(std::string_view(event.fields))
        .run();
    database.prepare("UPDATE job SET next_seq = next_seq + 1 WHERE id = ?")
        .bind(std::string_view(id))
        .run();
    touched_.insert(id);
}

void SqliteStore::end_cancelled(Database& database, const std::string& id, UnixMillis now) {
    append_event(database, id, {"cancelled", "{}", now});
    database.prepare("UPDATE job SET state = 4, finished = ?, expires = ? WHERE id = ?")
        .bind(now)
        .bind(now + retention_ms_)
        .bind(std::string_view(id))
        .run();
}

Stored<std::optional<Job>> SqliteStore::find_key(
    const std::string& idempotency_key, const std::string& request_hash
) {
    using Found = std::optional<Job>;
    return with_reader<Found>([&](Database& database) -> Stored<Found> {
        return job_of_key(database, idempotency_key, request_hash);
    });
}

Stored<Submitted> SqliteStore::submit(const NewJob& job, std::size_t queue_max) {
    return writer_->call<Submitted>([&](Database& database) -> Stored<Submitted> {
        if (!job.idempotency_key.empty()) {
            auto known = job_of_key(database, job.idempotency_key, job.request_hash);
            if (!known) {
                return tl::unexpected(std::move(known.error()));
            }
            if (*known) {
                return Submitted{std::move(**known), true};
            }
        }
        {
            Statement queued = database.prepare("SELECT COUNT(*) FROM job WHERE state = 0");
            queued.step();
            if (queued.natural(0) >= queue_max) {
                return failure(
                    StoreErrorCode::kQueueFull,
                    std::to_string(queue_max) + " jobs are waiting, as many as are taken"
                );
            }
        }
        database
            .prepare(
                "INSERT INTO job (id, solver, seed, priority, request, example_id, "
                "request_hash, idempotency_key, state, deadline, created) "
                "VALUES (?, ?, ?, ?, ?, ?, ?, ?, 0, ?, ?)"
            )
            .bind(std::string_view(job.id))
            .bind(std::string_view(job.solver))
            .bind(job.seed)
            .bind(std::int64_t{job.priority})
            .bind(std::string_view(job.request))
            .bind(std::string_view(job.example_id))
            .bind(std::string_view(job.request_hash))
            .bind(
                job.idempotency_key.empty() ? std::optional<std::string_view>()
                                            : std::string_view(job.idempotency_key)
            )
            .bind(job.deadline_seconds)
            .bind(job.created)
            .run();
        const std::uint64_t position = queue_position(database, job.id, job.created);
        append_event(database, job.id, {"queued", proto::queued_fields(position), job.created});
        auto stored = find_job(database, job.id);
        if (!stored) {
            return tl::unexpected(std::move(stored.error()));
        }
        stored->queue_position = position;
        return Submitted{std::move(*stored), false};
    });
}

Stored<Job> SqliteStore::find(const std::string& id) {
    return with_reader<Job>([&id](Database& database) { return find_job(database, id); });
}

Stored<JobPage> SqliteStore::list(const JobQuery& query) {
    std::int64_t before = std::numeric_limits<std::int64_t>::max();
    if (!query.cursor.empty()) {
        const char* end = query.cursor.data() + query.cursor.size();
        const auto parsed = std::from_chars(query.cursor.data(), end, before, 36);
        if (parsed.ec != std::errc() || parsed.ptr != end || before <= 0) {
            return failure(StoreErrorCode::kInvalid, "the cursor is not one that was given out");
        }
    }
    return with_reader<JobPage>([&](Database& database) -> Stored<JobPage> {
        const std::string filter = query.state ? " AND state = ?3" : "";
        Statement rows = database.prepare(
            std::string("SELECT ") + kJobColumns + " FROM job WHERE ordinal < ?1" + filter +
            " ORDER BY ordinal DESC LIMIT ?2"
        );
        rows.bind(before).bind(std::uint64_t{query.limit + 1});
        if (query.state) {
            rows.bind(static_cast<std::int64_t>(*query.state));
        }
        JobPage page;
        std::int64_t last = 0;
        while (rows.step()) {
            if (page.jobs.size() == query.limit) {
                std::array<char, 16> digits;
                const auto end =
                    std::to_chars(digits.data(), digits.data() + digits.size(), last, 36).ptr;
                page.next = std::string(digits.data(), end);
                break;
            }
            last = rows.integer(13);
            page.jobs.push_back(job_of(rows));
        }
        for (Job& job : page.jobs) {
            if (job.state == JobState::kQueued) {
                job.queue_position = queue_position(database, job.id, now_millis());
            }
        }
        return page;
    });
}

Stored<std::size_t> SqliteStore::queued_count() {
    return with_reader<std::size_t>([](Database& database) -> Stored<std::size_t> {
        Statement row = database.prepare("SELECT COUNT(*) FROM job WHERE state = 0");
        row.step();
        return static_cast<std::size_t>(row.natural(0));
    });
}

Stored<std::optional<Claim>> SqliteStore::claim(UnixMillis now) {
    return writer_->call<std::optional<Claim>>(
        [&](Database& database) -> Stored<std::optional<Claim>> {
            Claim claim;
            {
                Statement next = database.prepare(
                    std::string("SELECT id, token, deadline, solved_seconds, solver_version, "
                                "fruitless_claims, next_seq FROM job WHERE state = 0 ORDER BY ") +
                    kEffectivePriority + " DESC, ordinal LIMIT 1"
                );
                next.bind(now);
                if (!next.step()) {
                    return std::optional<Claim>();
                }
                claim.lease = {next.text(0), next.natural(1) + 1};
                if (!next.is_null(2)) {
                    claim.deadline_seconds = next.real(2);
                }
                claim.solved_seconds = next.real(3);
                claim.solver_version = next.text(4);
                claim.fruitless_claims = static_cast<std::uint32_t>(next.natural(5));
                claim.head = next.natural(6) - 1;
            }
            database
                .prepare(
                    "UPDATE job SET state = 1, token = ?, started = COALESCE(started, ?) "
                    "WHERE id = ?"
                )
                .bind(claim.lease.token)
                .bind(now)
                .bind(std::string_view(claim.lease.job_id))
                .run();
            auto job = find_job(database, claim.lease.job_id);
            if (!job) {
                return tl::unexpected(std::move(job.error()));
            }
            claim.job = std::move(*job);
            claim.blocks_logged = claim.job.blocks_done;
            return std::optional<Claim>(std::move(claim));
        }
    );
}

void SqliteStore::append(
    const Lease& lease,
    std::vector<NewEvent> events,
    const Progress& progress,
    std::function<void(const Stored<std::uint64_t>&)> done
) {
    auto first_seq = std::make_shared<std::uint64_t>(0);
    writer_->post(
        {[this, lease, events = std::move(events), progress, first_seq](Database& database
         ) -> Stored<void> {
             if (!holds(database, lease)) {
                 return lease_lost(lease);
             }
             {
                 Statement row = database.prepare("SELECT next_seq FROM job WHERE id = ?");
                 row.bind(std::string_view(lease.job_id)).step();
                 *first_seq = row.natural(0);
             }
             bool has_block = false;
             for (const NewEvent& event : events) {
                 append_event(database, lease.job_id, event);
                 has_block = has_block || event.type == "block";
             }
             database
                 .prepare(
                     "UPDATE job SET blocks_done = ?, blocks_total = ?, solver_version = ?, "
                     "solved_seconds = ?, fruitless_claims = CASE WHEN ? THEN 0 ELSE "
                     "fruitless_claims END WHERE id = ?"
                 )
                 .bind(std::uint64_t{progress.blocks_done})
                 .bind(std::uint64_t{progress.blocks_total})
                 .bind(std::string_view(progress.solver_version))
                 .bind(progress.solved_seconds)
                 .bind(std::int64_t{has_block})
                 .bind(std::string_view(lease.job_id))
                 .run();
             return {};
         },
         [first_seq, done = std::move(done)](const Stored<void>& committed) {
             if (committed) {
                 done(*first_seq);
             } else {
                 done(tl::unexpected(committed.error()));
             }
         }}
    );
}

Stored<void> SqliteStore::link_artifacts(
    Database& database, const std::string& id, const std::vector<ArtifactLink>& artifacts
) {
    for (const ArtifactLink& artifact : artifacts) {
        if (!artifacts_->exists(artifact.digest)) {
            return failure(
                StoreErrorCode::kConflict, "artifact " + artifact.digest + " is not stored"
            );
        }
        database.prepare("INSERT OR IGNORE INTO job_artifact VALUES (?, ?, ?)")
            .bind(std::string_view(id))
            .bind(std::string_view(artifact.name))
            .bind(std::string_view(artifact.digest))
            .run();
    }
    return {};
}

Stored<Job> SqliteStore::finish(const Lease& lease, const Outcome& outcome) {
    return writer_->call<Job>([&](Database& database) -> Stored<Job> {
        const std::string& id = lease.job_id;
        bool cancel_requested = false;
        {
            Statement row =
                database.prepare("SELECT token, state, cancel_requested FROM job WHERE id = ?");
            row.bind(std::string_view(id));
            if (!row.step() || row.natural(0) != lease.token) {
                return lease_lost(lease);
            }
            const auto state = static_cast<JobState>(row.integer(1));
            if (proto::is_ended(state)) {
                return find_job(database, id);
            }
            if (state != JobState::kRunning) {
                return lease_lost(lease);
            }
            cancel_requested = row.integer(2) != 0;
        }
        const JobState state = cancel_requested ? JobState::kCancelled : outcome.state;
        const bool succeeded = state == JobState::kSucceeded;
        const bool failed = state == JobState::kFailed;
        if (!succeeded) {
            // What is left of an unfinished job is its preview.
            std::vector<ArtifactLink> kept;
            for (const ArtifactLink& artifact : outcome.artifacts) {
                if (!artifact.name.ends_with(".glb")) {
                    kept.push_back(artifact);
                }
            }
            if (auto linked = link_artifacts(database, id, kept); !linked) {
                return tl::unexpected(std::move(linked.error()));
            }
        } else if (auto linked = link_artifacts(database, id, outcome.artifacts); !linked) {
            return tl::unexpected(std::move(linked.error()));
        }
        const std::string type(proto::state_name(state));
        const std::string fields = succeeded ? proto::succeeded_fields(outcome.result)
                                   : failed  ? proto::failed_fields(outcome.error)
                                             : "{}";
        append_event(database, id, {type, fields, outcome.finished});
        database
            .prepare(
                "UPDATE job SET state = ?, finished = ?, expires = ?, result = ?, error = ? "
                "WHERE id = ?"
            )
            .bind(static_cast<std::int64_t>(state))
            .bind(outcome.finished)
            .bind(outcome.finished + retention_ms_)
            .bind(std::string_view(succeeded ? outcome.result : ""))
            .bind(std::string_view(failed ? outcome.error : ""))
            .bind(std::string_view(id))
            .run();
        return find_job(database, id);
    });
}

Stored<void> SqliteStore::release(const Lease& lease, double solved_seconds) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        if (!holds(database, lease)) {
            return lease_lost(lease);
        }
        database.prepare("UPDATE job SET state = 0, solved_seconds = ? WHERE id = ?")
            .bind(solved_seconds)
            .bind(std::string_view(lease.job_id))
            .run();
        return {};
    });
}

Stored<Job> SqliteStore::cancel(const std::string& id, UnixMillis now) {
    return writer_->call<Job>([&](Database& database) -> Stored<Job> {
        auto job = find_job(database, id);
        if (!job || proto::is_ended(job->state)) {
            return job;
        }
        if (job->state == JobState::kRunning) {
            database.prepare("UPDATE job SET cancel_requested = 1 WHERE id = ?")
                .bind(std::string_view(id))
                .run();
            return job;
        }
        end_cancelled(database, id, now);
        return find_job(database, id);
    });
}

void SqliteStore::unlink_artifacts(Database& database, const std::string& id, bool keep_job) {
    {
        Statement rows = database.prepare("SELECT digest FROM job_artifact WHERE job_id = ?");
        rows.bind(std::string_view(id));
        while (rows.step()) {
            unlinked_digests_.push_back(rows.text(0));
        }
    }
    if (keep_job) {
        database.prepare("DELETE FROM job_artifact WHERE job_id = ?")
            .bind(std::string_view(id))
            .run();
    }
}

Stored<void> SqliteStore::erase(const std::string& id) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        unlink_artifacts(database, id, false);
        database.prepare("DELETE FROM job WHERE id = ?").bind(std::string_view(id)).run();
        if (database.changes() == 0) {
            return no_job(id);
        }
        touched_.insert(id);
        return {};
    });
}

Stored<std::string> SqliteStore::artifact(const std::string& id, const std::string& name) {
    return with_reader<std::string>([&](Database& database) -> Stored<std::string> {
        Statement row =
            database.prepare("SELECT digest FROM job_artifact WHERE job_id = ? AND name = ?");
        row.bind(std::string_view(id)).bind(std::string_view(name));
        if (!row.step()) {
            return failure(StoreErrorCode::kNotFound, "the job has no artifact " + name);
        }
        return row.text(0);
    });
}

Stored<void> SqliteStore::link(const std::string& id, const ArtifactLink& link) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        Statement row = database.prepare("SELECT 1 FROM job WHERE id = ?");
        row.bind(std::string_view(id));
        if (!row.step()) {
            return no_job(id);
        }
        return link_artifacts(database, id, {link});
    });
}

void SqliteStore::expire(UnixMillis now) {
    // The job stays and tells that its model is gone; a failure is tried again the next time.
    static_cast<void>(writer_->call<void>([&](Database& database) -> Stored<void> {
        std::vector<std::string> expired;
        {
            Statement rows = database.prepare(
                "SELECT id FROM job WHERE expires < ? AND EXISTS "
                "(SELECT 1 FROM job_artifact WHERE job_id = job.id) LIMIT 1000"
            );
            rows.bind(now);
            while (rows.step()) {
                expired.push_back(rows.text(0));
            }
        }
        for (const std::string& id : expired) {
            unlink_artifacts(database, id, true);
        }
        return {};
    }));
}

Stored<EventPage> SqliteStore::read(
    const std::string& job_id, std::uint64_t after, std::size_t limit
) {
    return with_reader<EventPage>([&](Database& database) -> Stored<EventPage> {
        EventPage page;
        {
            Statement row = database.prepare("SELECT next_seq, state FROM job WHERE id = ?");
            row.bind(std::string_view(job_id));
            if (!row.step()) {
                return no_job(job_id);
            }
            page.head = row.natural(0) - 1;
            page.ended = proto::is_ended(static_cast<JobState>(row.integer(1)));
        }
        Statement rows = database.prepare(
            "SELECT seq, type, fields, time FROM event WHERE job_id = ? AND seq > ? "
            "ORDER BY seq LIMIT ?"
        );
        rows.bind(std::string_view(job_id))
            .bind(static_cast<std::int64_t>(
                std::min<std::uint64_t>(after, std::numeric_limits<std::int64_t>::max())
            ))
            .bind(std::uint64_t{limit});
        while (rows.step()) {
            page.events.push_back({rows.natural(0), rows.text(1), rows.text(2), rows.integer(3)});
        }
        return page;
    });
}

std::unique_ptr<EventLog::Subscription> SqliteStore::subscribe(
    const std::string& job_id, std::function<void()> changed
) {
    return std::make_unique<Listener>(*this, job_id, std::move(changed));
}

Stored<void> SqliteStore::add_example(const Row& row, std::size_t count_max) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        {
            Statement known = database.prepare("SELECT 1 FROM example WHERE id = ?");
            known.bind(std::string_view(row.id));
            if (known.step()) {
                return {};
            }
        }
        {
            Statement count = database.prepare("SELECT COUNT(*) FROM example");
            count.step();
            if (count.natural(0) >= count_max) {
                return failure(
                    StoreErrorCode::kQueueFull,
                    std::to_string(count_max) + " examples are kept, as many as are taken"
                );
            }
        }
        if (!artifacts_->exists(row.digest)) {
            return failure(StoreErrorCode::kConflict, "the example's text is not stored");
        }
        database.prepare("INSERT INTO example VALUES (?, ?, ?)")
            .bind(std::string_view(row.id))
            .bind(std::string_view(row.name))
            .bind(std::string_view(row.digest))
            .run();
        return {};
    });
}

Stored<ExampleStore::Row> SqliteStore::find_example(const std::string& id) {
    return with_reader<Row>([&id](Database& database) -> Stored<Row> {
        Statement row = database.prepare("SELECT id, name, digest FROM example WHERE id = ?");
        row.bind(std::string_view(id));
        if (!row.step()) {
            return failure(StoreErrorCode::kNotFound, "there is no example " + id);
        }
        return Row{row.text(0), row.text(1), row.text(2)};
    });
}

Stored<std::vector<ExampleStore::Row>> SqliteStore::list_examples() {
    return with_reader<std::vector<Row>>([](Database& database) -> Stored<std::vector<Row>> {
        std::vector<Row> rows;
        Statement found = database.prepare("SELECT id, name, digest FROM example ORDER BY id");
        while (found.step()) {
            rows.push_back({found.text(0), found.text(1), found.text(2)});
        }
        return rows;
    });
}

Stored<void> SqliteStore::erase_example(const std::string& id) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        Statement users =
            database.prepare("SELECT 1 FROM job WHERE state IN (0, 1) AND example_id = ?");
        users.bind(std::string_view(id));
        if (users.step()) {
            return failure(StoreErrorCode::kConflict, "an unfinished job uses the example");
        }
        {
            Statement row = database.prepare("SELECT digest FROM example WHERE id = ?");
            row.bind(std::string_view(id));
            if (!row.step()) {
                return failure(StoreErrorCode::kNotFound, "there is no example " + id);
            }
            unlinked_digests_.push_back(row.text(0));
        }
        database.prepare("DELETE FROM example WHERE id = ?").bind(std::string_view(id)).run();
        return {};
    });
}

}  // namespace modelsynth::server
