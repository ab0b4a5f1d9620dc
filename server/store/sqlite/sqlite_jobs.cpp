// What clients ask of the embedded store: jobs in, jobs out.

#include "server/store/artifact_names.h"
#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

namespace modelsynth::server {

using proto::Job;
using proto::JobState;
using proto::UnixMillis;

namespace {

// A place in the list as a client is given it: a number, and four digits that follow from it, so
// that what was typed or cut short is told from what was given out.
constexpr int kCursorBase = 36;
constexpr std::size_t kCheckDigits = 4;

std::string cursor_of(std::int64_t place) {
    constexpr std::uint64_t kLeast = 36 * 36 * 36;  // of so many digits
    const std::uint64_t mixed = static_cast<std::uint64_t>(place) * 0x9E37'79B9'7F4A'7C15 >> 32;
    const std::uint64_t check = kLeast + mixed % (kLeast * 35);
    std::array<char, 24> digits;
    char* const end = digits.data() + digits.size();
    char* const middle = std::to_chars(digits.data(), end, place, kCursorBase).ptr;
    return {digits.data(), std::to_chars(middle, end, check, kCursorBase).ptr};
}

std::optional<std::int64_t> place_of_cursor(const std::string& cursor) {
    if (cursor.size() <= kCheckDigits) {
        return std::nullopt;
    }
    std::int64_t place = 0;
    const char* const end = cursor.data() + cursor.size() - kCheckDigits;
    const auto parsed = std::from_chars(cursor.data(), end, place, kCursorBase);
    const bool is_one = parsed.ec == std::errc() && place > 0 && cursor_of(place) == cursor;
    return is_one ? std::optional(place) : std::nullopt;
}

// The job of an idempotency key, or nothing; a conflict when the key was used for another request.
Stored<std::optional<Job>> job_of_key(
    Database& database,
    const std::string& owner,
    const std::string& key,
    const std::string& request_hash
) {
    std::string id;
    {
        Statement known = database.prepare(
            "SELECT id, request_hash FROM job WHERE owner = ? AND idempotency_key = ?"
        );
        known.bind(std::string_view(owner)).bind(std::string_view(key));
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

// Fails with the limit that the job would pass.
Stored<void> find_room(Database& database, const NewJob& job, const QueueLimits& limits) {
    Statement queued = database.prepare("SELECT COUNT(*) FROM job WHERE state = 0");
    queued.step();
    if (queued.natural(0) >= limits.queued_max) {
        return failure(
            StoreErrorCode::kQueueFull,
            std::to_string(limits.queued_max) + " jobs are waiting, as many as are taken"
        );
    }
    // By these indexes, or it looks at all jobs that the owner ever had.
    Statement unfinished = database.prepare(
        "SELECT (SELECT COUNT(*) FROM job INDEXED BY job_queue WHERE state = 0 AND "
        "owner = ?1) + (SELECT COUNT(*) FROM job INDEXED BY job_running WHERE state = 1 "
        "AND owner = ?1)"
    );
    unfinished.bind(std::string_view(job.owner)).step();
    if (unfinished.natural(0) >= limits.unfinished_max) {
        return failure(
            StoreErrorCode::kOwnerFull,
            std::to_string(limits.unfinished_max) +
                " jobs of the key are unfinished, as many as it may have"
        );
    }
    if (job.webhook.empty()) {
        return {};
    }
    Statement deliveries = database.prepare("SELECT COUNT(*) FROM delivery WHERE owner = ?");
    deliveries.bind(std::string_view(job.owner)).step();
    if (deliveries.natural(0) >= limits.deliveries_max) {
        return failure(
            StoreErrorCode::kWebhooksFull,
            std::to_string(limits.deliveries_max) +
                " webhooks of the key are not delivered, as many as may wait"
        );
    }
    return {};
}

}  // namespace

Stored<std::optional<Job>> SqliteStore::find_key(
    const std::string& owner, const std::string& idempotency_key, const std::string& request_hash
) {
    using Found = std::optional<Job>;
    return with_reader<Found>([&](Database& database) -> Stored<Found> {
        return job_of_key(database, owner, idempotency_key, request_hash);
    });
}

Stored<Submitted> SqliteStore::submit(const NewJob& job, const QueueLimits& limits) {
    return writer_->call<Submitted>([&](Database& database) -> Stored<Submitted> {
        if (!job.idempotency_key.empty()) {
            auto known = job_of_key(database, job.owner, job.idempotency_key, job.request_hash);
            if (!known) {
                return tl::unexpected(std::move(known.error()));
            }
            if (*known) {
                return Submitted{std::move(**known), true};
            }
        }
        if (auto room = find_room(database, job, limits); !room) {
            return tl::unexpected(std::move(room.error()));
        }
        const std::uint64_t turn = turn_of_next(database, job.owner, job.priority);
        database
            .prepare(
                "INSERT INTO job (id, solver, seed, priority, request, example_id, "
                "request_hash, idempotency_key, state, deadline, created, owner, cost, "
                "memory_bytes, turn, traceparent, webhook) "
                "VALUES (?, ?, ?, ?, ?, ?, ?, ?, 0, ?, ?, ?, ?, ?, ?, ?, ?)"
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
            .bind(std::string_view(job.owner))
            .bind(job.cost)
            .bind(job.memory_bytes)
            .bind(turn)
            .bind(std::string_view(job.traceparent))
            .bind(std::string_view(job.webhook))
            .run();
        if (auto linked = link_artifacts(database, job.id, job.artifacts); !linked) {
            return tl::unexpected(std::move(linked.error()));
        }
        const std::uint64_t position = queue_position(database, job.id, job.created);
        append_event(database, job.id, {"queued", proto::queued_fields(position), job.created});
        auto stored = read_job(database, job.id);
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
        const auto place = place_of_cursor(query.cursor);
        if (!place) {
            return failure(StoreErrorCode::kInvalid, "the cursor is not one that was given out");
        }
        before = *place;
    }
    return with_reader<JobPage>([&](Database& database) -> Stored<JobPage> {
        Statement rows = database.prepare(
            std::string("SELECT ") + kJobColumns + " FROM job WHERE ordinal < ?" +
            (query.state ? " AND state = ?" : "") + (query.owner ? " AND owner = ?" : "") +
            " ORDER BY ordinal DESC LIMIT ?"
        );
        rows.bind(before);
        if (query.state) {
            rows.bind(static_cast<std::int64_t>(*query.state));
        }
        if (query.owner) {
            rows.bind(std::string_view(*query.owner));
        }
        rows.bind(std::uint64_t{query.limit + 1});
        JobPage page;
        std::int64_t last = 0;
        while (rows.step()) {
            if (page.jobs.size() == query.limit) {
                page.next = cursor_of(last);
                break;
            }
            last = rows.integer(13);
            page.jobs.push_back(job_of(rows));
        }
        for (Job& job : page.jobs) {
            if (job.state == JobState::kQueued) {
                job.queue_position = queue_position(database, job.id, proto::now_millis());
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

Stored<void> SqliteStore::erase(const std::string& id) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        unlink_artifacts(database, id, Unlinked::kAll);
        database.prepare("DELETE FROM job WHERE id = ?").bind(std::string_view(id)).run();
        if (database.changes() == 0) {
            return no_job(id);
        }
        gaps_.erase(id);
        touch(id, News::kEnd);
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

Stored<std::optional<JobCheckpoint>> SqliteStore::checkpoint(const std::string& id) {
    using Found = std::optional<JobCheckpoint>;
    return with_reader<Found>([&id](Database& database) -> Stored<Found> {
        return find_checkpoint(database, id);
    });
}

Stored<void> SqliteStore::link(const std::string& id, const ArtifactLink& link) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        Statement row = database.prepare("SELECT state FROM job WHERE id = ?");
        row.bind(std::string_view(id));
        if (!row.step()) {
            return no_job(id);
        }
        auto linked = link_artifacts(database, id, {link});
        if (linked && link.name == kPreviewArtifact &&
            proto::is_ended(static_cast<JobState>(row.integer(0)))) {
            drop_checkpoint(database, id);  // the preview tells more
        }
        return linked;
    });
}

}  // namespace modelsynth::server
