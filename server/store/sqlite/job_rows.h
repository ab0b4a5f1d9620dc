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
    "request, result, error, ordinal, next_seq";
inline constexpr int kOrdinalColumn = 13;

// A job that waited this long counts as one priority level higher, so that none starves. ?1 is
// the time.
inline constexpr const char* kEffectivePriority = "(priority + (?1 - created) / 30000)";

[[nodiscard]] tl::unexpected<StoreError> failure(StoreErrorCode code, std::string message);
[[nodiscard]] tl::unexpected<StoreError> no_job(const std::string& id);
[[nodiscard]] tl::unexpected<StoreError> lease_lost(const Lease& lease);

// The job of a row of kJobColumns; without its place in the queue.
[[nodiscard]] proto::Job job_of(const Statement& row);

// How many queued jobs go before this one, by the order of claim().
[[nodiscard]] std::uint64_t queue_position(
    Database& database, const std::string& id, proto::UnixMillis now
);

// Fails: kNotFound.
[[nodiscard]] Stored<proto::Job> find_job(Database& database, const std::string& id);

[[nodiscard]] std::optional<JobCheckpoint> find_checkpoint(
    Database& database, const std::string& id
);

// Whether the lease still holds the job.
[[nodiscard]] bool holds(Database& database, const Lease& lease);

}  // namespace modelsynth::server
