// What the embedded store gives up of ended jobs: first what they made, then that they ever were.
// A failure is tried again the next time.

#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <algorithm>
#include <string>
#include <vector>

namespace modelsynth::server {

using proto::UnixMillis;

namespace {

// At a time, so that nobody waits long for the writer meanwhile.
constexpr std::uint64_t kExpiredMax = 1000;
constexpr std::uint64_t kForgottenMax = 100;  // with all their events
constexpr std::uint64_t kShedMax = 100;

constexpr const char* kHasSomething =
    "(EXISTS (SELECT 1 FROM job_artifact WHERE job_id = job.id) OR "
    "EXISTS (SELECT 1 FROM checkpoint WHERE job_id = job.id))";

// The ids that a statement of one parameter and a limit gives.
std::vector<std::string> ids_of(
    Database& database, const std::string& query, UnixMillis parameter, std::uint64_t limit
) {
    std::vector<std::string> ids;
    Statement rows = database.prepare(query + " LIMIT ?2");
    rows.bind(parameter).bind(limit);
    while (rows.step()) {
        ids.push_back(rows.text(0));
    }
    return ids;
}

}  // namespace

void SqliteStore::take_artifacts(Database& database, const std::string& id) {
    unlink_artifacts(database, id, Unlinked::kAll);
    database.prepare("DELETE FROM checkpoint WHERE job_id = ?").bind(std::string_view(id)).run();
}

void SqliteStore::expire(UnixMillis now) {
    // The job stays and tells that its model is gone.
    static_cast<void>(writer_->call<void>([&](Database& database) -> Stored<void> {
        const std::string expired =
            std::string("SELECT id FROM job WHERE expires < ?1 AND ") + kHasSomething;
        for (const std::string& id : ids_of(database, expired, now, kExpiredMax)) {
            take_artifacts(database, id);
        }
        return {};
    }));
}

void SqliteStore::forget(UnixMillis then) {
    static_cast<void>(writer_->call<void>([&](Database& database) -> Stored<void> {
        const std::string old = "SELECT id FROM job WHERE expires < ?1 ORDER BY expires";
        for (const std::string& id : ids_of(database, old, then, kForgottenMax)) {
            unlink_artifacts(database, id, Unlinked::kAll);
            database.prepare("DELETE FROM job WHERE id = ?").bind(std::string_view(id)).run();
            touch(id, News::kEnd);
        }
        return {};
    }));
}

void SqliteStore::shed(std::uint64_t bytes_max, UnixMillis now) {
    static_cast<void>(writer_->call<void>([&](Database& database) -> Stored<void> {
        std::uint64_t left = artifacts_->space().used_bytes;
        const std::string next = std::string("SELECT id FROM job WHERE expires >= ?1 AND ") +
                                 kHasSomething + " ORDER BY expires, ordinal";
        for (const std::string& id : ids_of(database, next, now, kShedMax)) {
            if (left <= bytes_max) {
                break;
            }
            const std::size_t seen = unlinked_digests_.size();
            take_artifacts(database, id);
            database.prepare("UPDATE job SET expires = ? WHERE id = ?")
                .bind(now - 1)
                .bind(std::string_view(id))
                .run();
            for (std::size_t i = seen; i < unlinked_digests_.size(); ++i) {
                const std::string& digest = unlinked_digests_[i];
                if (!is_digest_used(database, digest)) {
                    left -= std::min(left, artifacts_->size_of(digest));
                }
            }
        }
        return {};
    }));
}

}  // namespace modelsynth::server
