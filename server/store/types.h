#pragma once

#include "proto/job.h"
#include "proto/timestamp.h"

#include <tl/expected.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::server {

// How a call of the store can fail.
enum class StoreErrorCode : std::uint8_t {
    kNotFound,
    kConflict,      // same key with another request, an illegal transition, a missing digest
    kQueueFull,     // as many jobs are queued as the caller allows
    kOwnerFull,     // as many jobs of one owner are unfinished
    kWebhooksFull,  // as many webhooks of one owner are not delivered
    kLeaseLost,     // another holder now, or the job is gone
    kInvalid,       // a malformed cursor
    kCorrupt,       // a file is not what its digest says
    kUnavailable,   // certainly not applied; the same call may be repeated
    kClosed,        // the store is shutting down
};

struct StoreError {
    StoreErrorCode code = StoreErrorCode::kUnavailable;
    std::string message;
};

template <class T>
using Stored = tl::expected<T, StoreError>;

struct ArtifactLink {
    std::string name;  // see artifact_names.h
    std::string digest;
};

// Whose things a call means: those of one owner, the name of a key, or nothing for everybody's. Of
// another owner's things a call speaks as of things that are not there.
using OwnerFilter = std::optional<std::string>;

// A job as it is submitted.
struct NewJob {
    std::string id;
    std::string owner = {};  // empty: nobody's, where there are no keys
    std::string solver;
    std::uint64_t seed = 0;
    std::int32_t priority = 0;
    std::string request;          // JSON, what the job shows and what a worker runs
    std::string example_id;       // empty: inline
    std::string request_hash;     // of what the client sent, for idempotency
    std::string idempotency_key;  // empty: none
    std::optional<double> deadline_seconds;
    std::vector<ArtifactLink> artifacts = {};  // what it needs of others, kept with it from now on
    proto::UnixMillis created = 0;
    std::uint64_t cost = 1;  // of running it, in any unit; what owners share is counted in it
    std::uint64_t memory_bytes = 0;  // that running it takes
    std::string traceparent = {};
    std::string webhook = {};  // URL that is told of its end; empty: none
};

// How much may be waiting already for a job to be taken.
struct QueueLimits {
    std::size_t queued_max = 0;                                            // jobs in all
    std::size_t unfinished_max = std::numeric_limits<std::size_t>::max();  // of the job's owner
    // Deliveries of the job's owner; of jobs that have a webhook alone.
    std::size_t deliveries_max = std::numeric_limits<std::size_t>::max();
};

// What a job may be to be handed out.
struct ClaimLimits {
    std::uint64_t memory_bytes_max = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t cost_max = std::numeric_limits<std::uint64_t>::max();
};

struct Submitted {
    proto::Job job;
    bool replayed = false;  // the key was known; this is the first answer's job
};

// The right to run a job. The token grows with every claim, so that a holder that was declared
// dead cannot write any more.
struct Lease {
    std::string job_id;
    std::uint64_t token = 0;
};

// How far a running job's model has come, for a later claim to go on from and for its preview
// meanwhile. It may lag behind the log, never run ahead of it.
struct JobCheckpoint {
    std::uint64_t seq = 0;  // the newest event included
    std::uint32_t blocks_done = 0;
    std::string tally;   // what became of the blocks, see proto::encode_tally()
    std::string labels;  // see proto::encode_labels()
};

// A job handed to a worker.
struct Claim {
    Lease lease;
    proto::Job job;
    std::optional<double> deadline_seconds;
    std::uint64_t cost = 0;
    std::uint64_t memory_bytes = 0;
    double solved_seconds = 0;       // of earlier claims that did not end; counts to the deadline
    std::string solver_version;      // under which the job was last appended to; empty: never
    std::uint64_t version_base = 0;  // events up to this one tell of another model
    std::optional<JobCheckpoint> checkpoint;  // made under it
    std::uint64_t head = 0;                   // newest seq
    std::uint32_t fruitless_claims = 0;       // crashes since a block was last logged
};

struct NewEvent {
    std::string type;
    std::string fields;  // JSON object, see proto/job.h
    proto::UnixMillis time = 0;
};

struct Event {
    std::uint64_t seq = 0;
    std::string type;
    std::string fields;
    proto::UnixMillis time = 0;
};

// Where a job's progress stands after an append.
struct Progress {
    std::uint32_t blocks_done = 0;
    std::uint32_t blocks_total = 0;
    double solved_seconds = 0;
    std::string solver_version;
    // Kept in place of an older one when given. Its seq is set by the store: the last event of
    // the append.
    std::optional<JobCheckpoint> checkpoint;
    // Linked to the job from now on, whatever becomes of it.
    std::vector<ArtifactLink> artifacts = {};
};

// How a job ended.
struct Outcome {
    proto::JobState state = proto::JobState::kFailed;
    std::string result;  // JSON, for kSucceeded
    std::string error;   // JSON, for kFailed
    std::vector<ArtifactLink> artifacts;
    proto::UnixMillis finished = 0;
};

struct EventPage {
    std::vector<Event> events;  // contiguous, ascending
    std::uint64_t head = 0;     // newest seq of the log
    bool ended = false;         // the newest event is the last there will be
};

struct JobQuery {
    OwnerFilter owner = {};
    std::optional<proto::JobState> state;
    std::size_t limit = 20;
    std::string cursor;  // empty: from the newest
};

struct JobPage {
    std::vector<proto::Job> jobs;  // newest first
    std::optional<std::string> next;
};

}  // namespace modelsynth::server
