#pragma once

#include "server/store/sqlite/database.h"
#include "server/store/types.h"

#include <optional>
#include <string>

// What several calls of the embedded store read from the job table, within a transaction of the
// caller's.

namespace modelsynth::server {

// The columns that job_of() reads, and the job's place in the order of arrival after them.
inline constexpr const char* kJobColumns =
    "id, state, solver, seed, created, started, finished, expires, blocks_done, blocks_total, "
    "request, result, error, ordinal, next_seq, owner, traceparent";
inline constexpr int kOrdinalColumn = 13;

// The order of claim(): by level, then by turn. A flow is what an owner has of one priority; `turn`
// was given at the submission, see turn_of_next(), so within a flow it is the order in which jobs
// came in. Levels fall in that order, too, unless the clock was set back.
inline constexpr proto::UnixMillis kPatienceMs = 30'000;
inline constexpr const char* kQueue =
    "job LEFT JOIN flow ON flow.owner = job.owner AND flow.priority = job.priority";
// The priority, one higher for each time of patience in which nothing of the flow was handed out
// although there was this job to hand out. ?1 is the time.
inline constexpr const char* kLevel =
    "(job.priority + MAX(0, ?1 - MAX(job.created, COALESCE(flow.served, job.created))) / 30000)";

[[nodiscard]] tl::unexpected<StoreError> failure(StoreErrorCode code, std::string message);
[[nodiscard]] tl::unexpected<StoreError> no_job(const std::string& id);
[[nodiscard]] tl::unexpected<StoreError> lease_lost(const Lease& lease);

// The job of a row of kJobColumns; without its place in the queue.
[[nodiscard]] proto::Job job_of(const Statement& row);

// The turn of the next job that comes in of a flow: where the flow's unfinished jobs end, and not
// before the turn that is being served, since what was not asked for is not owed.
[[nodiscard]] std::uint64_t turn_of_next(
    Database& database, const std::string& owner, std::int32_t priority
);

// How many queued jobs go before this one, by the order of claim().
[[nodiscard]] std::uint64_t queue_position(
    Database& database, const std::string& id, proto::UnixMillis now
);

// Without its place in the queue. Fails: kNotFound.
[[nodiscard]] Stored<proto::Job> read_job(Database& database, const std::string& id);
[[nodiscard]] Stored<proto::Job> find_job(Database& database, const std::string& id);

[[nodiscard]] std::optional<JobCheckpoint> find_checkpoint(
    Database& database, const std::string& id
);
void drop_checkpoint(Database& database, const std::string& id);

// Whether a job or an example needs the artifact.
[[nodiscard]] bool is_digest_used(Database& database, const std::string& digest);

// Whether the lease still holds the job.
[[nodiscard]] bool holds(Database& database, const Lease& lease);

}  // namespace modelsynth::server
