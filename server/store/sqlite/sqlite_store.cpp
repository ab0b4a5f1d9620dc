// The embedded store as a whole: its directory, its start, and what happens after each commit.

#include "server/store/sqlite/sqlite_store.h"

#include "server/store/artifact_names.h"
#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/schema.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <utility>

namespace modelsynth::server {

using proto::Job;
using proto::JobState;
using proto::UnixMillis;

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
    } catch (const NewerSchema& newer) {
        ::close(lock);
        return failure(StoreErrorCode::kConflict, newer.what());
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
        if (!artifacts_->empty() && is_new(database)) {
            // An empty database would make orphans of all of them, and the sweep take them away.
            throw SqliteError(
                "the database is empty or gone, but there are artifacts; bring it back, or move "
                "them away to begin anew"
            );
        }
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
        const UnixMillis now = proto::now_millis();
        end_cancelled(database, id, now);
    }
    // One process: whoever held a lease is gone.
    database.execute(
        "UPDATE job SET state = 0, fruitless_claims = fruitless_claims + 1 WHERE state = 1"
    );
    database.execute("COMMIT");
}

void SqliteStore::after_commit(Database& database) {
    try {
        while (!unlinked_digests_.empty()) {
            if (!is_digest_used(database, unlinked_digests_.back())) {
                artifacts_->remove_if_unpinned(unlinked_digests_.back());
            }
            unlinked_digests_.pop_back();
        }
    } catch (const SqliteError&) {
        // The rest is looked at after the next commit.
    }
    tell_listeners(std::exchange(touched_, {}));
    if (std::exchange(has_new_deliveries_, false)) {
        const std::lock_guard lock(listeners_mutex_);
        if (on_delivery_) {
            on_delivery_();
        }
    }
}

void SqliteStore::append_event(Database& database, const std::string& id, const NewEvent& event) {
    std::uint64_t seq = 0;
    {
        Statement row = database.prepare("SELECT next_seq FROM job WHERE id = ?");
        row.bind(std::string_view(id)).step();
        seq = row.natural(0);
    }
    insert_event(database, id, seq, event);
    database.prepare("UPDATE job SET next_seq = ? WHERE id = ?")
        .bind(seq + 1)
        .bind(std::string_view(id))
        .run();
}

void SqliteStore::insert_event(
    Database& database, const std::string& id, std::uint64_t seq, const NewEvent& event
) {
    database.prepare("INSERT INTO event (job_id, seq, type, time, fields) VALUES (?, ?, ?, ?, ?)")
        .bind(std::string_view(id))
        .bind(seq)
        .bind(std::string_view(event.type))
        .bind(event.time)
        .bind(std::string_view(event.fields))
        .run();
    const auto state = proto::state_of(event.type);  // the last event has the name of the job's
    touch(id, state && proto::is_ended(*state) ? News::kEnd : News::kAny);
}

void SqliteStore::end_cancelled(Database& database, const std::string& id, UnixMillis now) {
    append_event(database, id, {"cancelled", "{}", now});
    database.prepare("UPDATE job SET state = 4, finished = ?, expires = ? WHERE id = ?")
        .bind(now)
        .bind(now + retention_ms_)
        .bind(std::string_view(id))
        .run();
    add_delivery(database, id, now);
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

void SqliteStore::unlink_artifacts(Database& database, const std::string& id, Unlinked which) {
    std::string where = " FROM job_artifact WHERE job_id = ?";
    if (which == Unlinked::kMade) {
        where +=
            std::string(" AND name NOT IN ('") + kExampleArtifact + "', '" + kOriginArtifact + "')";
    }
    {
        Statement rows = database.prepare("SELECT digest" + where);
        rows.bind(std::string_view(id));
        while (rows.step()) {
            unlinked_digests_.push_back(rows.text(0));
        }
    }
    database.prepare("DELETE" + where).bind(std::string_view(id)).run();
}

}  // namespace modelsynth::server
