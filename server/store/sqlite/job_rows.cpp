#include "server/store/sqlite/job_rows.h"

#include <utility>

namespace modelsynth::server {

using proto::Job;
using proto::JobState;
using proto::UnixMillis;

namespace {

std::optional<UnixMillis> optional_time(const Statement& row, int column) {
    return row.is_null(column) ? std::nullopt : std::optional(row.integer(column));
}

}  // namespace

tl::unexpected<StoreError> failure(StoreErrorCode code, std::string message) {
    return tl::unexpected(StoreError{code, std::move(message)});
}

tl::unexpected<StoreError> no_job(const std::string& id) {
    return failure(StoreErrorCode::kNotFound, "there is no job " + id);
}

tl::unexpected<StoreError> lease_lost(const Lease& lease) {
    return failure(StoreErrorCode::kLeaseLost, "job " + lease.job_id + " has another holder");
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
    job.owner = row.text(15);
    job.traceparent = row.text(16);
    return job;
}

std::uint64_t turn_of_next(Database& database, const std::string& owner, std::int32_t priority) {
    // By these indexes, or it may look at all jobs that the owner ever had.
    Statement row = database.prepare(
        "SELECT MAX((SELECT value FROM meta WHERE key = 'turn'), "
        "COALESCE((SELECT turn + cost FROM job INDEXED BY job_queue WHERE state = 0 AND "
        "owner = ?1 AND priority = ?2 ORDER BY turn DESC LIMIT 1), 0), "
        "COALESCE((SELECT MAX(turn + cost) FROM job INDEXED BY job_running WHERE state = 1 AND "
        "owner = ?1 AND priority = ?2), 0))"
    );
    row.bind(std::string_view(owner)).bind(std::int64_t{priority}).step();
    return row.natural(0);
}

std::uint64_t queue_position(Database& database, const std::string& id, UnixMillis now) {
    const std::string level = kLevel;
    const std::string queue = kQueue;
    Statement own = database.prepare(
        "SELECT " + level + ", turn, ordinal, job.owner, job.priority FROM " + queue +
        " WHERE id = ?2 AND state = 0"
    );
    own.bind(now).bind(std::string_view(id));
    if (!own.step()) {
        return 0;
    }
    // Those of its own flow by the index alone.
    Statement before = database.prepare(
        "SELECT (SELECT COUNT(*) FROM job INDEXED BY job_queue WHERE state = 0 AND owner = ?5 AND "
        "priority = ?6 AND turn < ?3) + (SELECT COUNT(*) FROM " +
        queue +
        " WHERE state = 0 AND "
        "(job.owner <> ?5 OR job.priority <> ?6) AND (" +
        level + " > ?2 OR (" + level + " = ?2 AND (turn < ?3 OR (turn = ?3 AND ordinal < ?4)))))"
    );
    const std::string owner = own.text(3);
    before.bind(now).bind(own.integer(0)).bind(own.integer(1)).bind(own.integer(2));
    before.bind(std::string_view(owner)).bind(own.integer(4));
    before.step();
    return before.natural(0);
}

Stored<Job> read_job(Database& database, const std::string& id) {
    Statement row =
        database.prepare(std::string("SELECT ") + kJobColumns + " FROM job WHERE id = ?");
    row.bind(std::string_view(id));
    if (!row.step()) {
        return no_job(id);
    }
    return job_of(row);
}

Stored<Job> find_job(Database& database, const std::string& id) {
    auto job = read_job(database, id);
    if (job && job->state == JobState::kQueued) {
        job->queue_position = queue_position(database, id, proto::now_millis());
    }
    return job;
}

std::optional<JobCheckpoint> find_checkpoint(Database& database, const std::string& id) {
    Statement row =
        database.prepare("SELECT seq, blocks_done, tally, labels FROM checkpoint WHERE job_id = ?");
    row.bind(std::string_view(id));
    if (!row.step()) {
        return std::nullopt;
    }
    return JobCheckpoint{
        row.natural(0), static_cast<std::uint32_t>(row.natural(1)), row.text(2), row.blob(3)};
}

void drop_checkpoint(Database& database, const std::string& id) {
    database.prepare("DELETE FROM checkpoint WHERE job_id = ?").bind(std::string_view(id)).run();
}

bool is_digest_used(Database& database, const std::string& digest) {
    Statement row = database.prepare(
        "SELECT EXISTS (SELECT 1 FROM job_artifact WHERE digest = ?1) OR "
        "EXISTS (SELECT 1 FROM example WHERE digest = ?1)"
    );
    row.bind(std::string_view(digest));
    return row.step() && row.integer(0) != 0;
}

bool holds(Database& database, const Lease& lease) {
    Statement row = database.prepare("SELECT token, state FROM job WHERE id = ?");
    row.bind(std::string_view(lease.job_id));
    return row.step() && row.natural(0) == lease.token &&
           static_cast<JobState>(row.integer(1)) == JobState::kRunning;
}

}  // namespace modelsynth::server
