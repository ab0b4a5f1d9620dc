#pragma once

#include "server/store/types.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::server {

// Durable jobs. An answer of success means that it is on disk. All calls block and may be made
// from any thread, none from a network thread. A mutating call may be repeated.
class JobStore {
  public:
    virtual ~JobStore() = default;

    // Job, key, links to artifacts and event 1 (`queued`) appear in one commit, or none does. A
    // key that its owner used before with the same hash answers with its job. Fails: kConflict (the
    // key has another hash, or a digest is not stored), kQueueFull, kOwnerFull, kWebhooksFull.
    [[nodiscard]] virtual Stored<Submitted> submit(
        const NewJob& job, const QueueLimits& limits
    ) = 0;

    // The job that the owner submitted with the key, or nothing. Fails: kConflict as submit().
    [[nodiscard]] virtual Stored<std::optional<proto::Job>> find_key(
        const std::string& owner,
        const std::string& idempotency_key,
        const std::string& request_hash
    ) = 0;

    [[nodiscard]] virtual Stored<proto::Job> find(const std::string& id) = 0;
    [[nodiscard]] virtual Stored<JobPage> list(const JobQuery& query) = 0;
    [[nodiscard]] virtual Stored<std::size_t> queued_count() = 0;

    // The next queued job that keeps to the limits; it is then running. Nothing when there is none.
    // Higher priority goes first. Among jobs of one priority owners take turns, so that each
    // comes by as much of what jobs cost as any other (start-time fair queueing; Goyal, Vin and
    // Cheng 1996); those of one owner go in order of arrival. None starves: jobs of an owner and
    // priority count as one level higher for each 30 s in which none of them was handed out. A job
    // whose memory is not free is passed by until it has waited 30 s; from then on all others wait
    // for it.
    [[nodiscard]] virtual Stored<std::optional<Claim>> claim(
        proto::UnixMillis now, const ClaimLimits& limits
    ) = 0;

    // Appends events of a running job, numbered in the commit that writes them, and its checkpoint
    // and links to artifacts in the same one. Under another solver version than the append before,
    // the older checkpoint and models go: they are not what this solver makes. Returns at once;
    // `done` is called on the store's thread, in order of the lease's calls, with the first seq
    // once they are on disk. Blocks while too much waits to be written. After one that failed every
    // other of the lease fails, too, and so does finish(): a log has no gaps. Fails: kLeaseLost,
    // kConflict when a digest is not stored.
    virtual void append(
        const Lease& lease,
        std::vector<NewEvent> events,
        const Progress& progress,
        std::function<void(const Stored<std::uint64_t>&)> done
    ) = 0;

    // Ends a running job: state, last event and links to artifacts in one commit. A job whose
    // cancellation was asked for before ends as cancelled, whatever the outcome says. Repeating
    // answers the same. Fails: kLeaseLost, kConflict when a digest is not stored.
    [[nodiscard]] virtual Stored<proto::Job> finish(const Lease& lease, const Outcome& outcome) = 0;

    // Gives a running job back to the queue; costs no attempt. One whose cancellation was asked for
    // ends as cancelled instead. Fails: kLeaseLost.
    [[nodiscard]] virtual Stored<void> release(const Lease& lease, double solved_seconds) = 0;

    // Ends a queued job, marks a running one so that its holder ends it, leaves an ended one.
    [[nodiscard]] virtual Stored<proto::Job> cancel(
        const std::string& id, proto::UnixMillis now
    ) = 0;

    // Forgets the job, its key, its events and those of its artifacts that nothing else uses.
    [[nodiscard]] virtual Stored<void> erase(const std::string& id) = 0;

    // An artifact of the job by name.
    [[nodiscard]] virtual Stored<std::string> artifact(
        const std::string& id, const std::string& name
    ) = 0;

    // How far the model of a job that has not ended well has come; nothing when no claim of it
    // kept any, or when the labels that the job left behind tell it.
    [[nodiscard]] virtual Stored<std::optional<JobCheckpoint>> checkpoint(const std::string& id
    ) = 0;

    // Adds an artifact to a finished job; one of that name stays. A preview takes the place of the
    // checkpoint.
    [[nodiscard]] virtual Stored<void> link(const std::string& id, const ArtifactLink& link) = 0;

    // Takes the artifacts and checkpoints of jobs that expired before `now`.
    virtual void expire(proto::UnixMillis now) = 0;

    // Forgets ended jobs, with their events, that expired before `then`.
    virtual void forget(proto::UnixMillis then) = 0;

    // While artifacts take more than `bytes_max`, has ended jobs expire, those that would do so
    // first before others. What others still need of theirs stays.
    virtual void shed(std::uint64_t bytes_max, proto::UnixMillis now) = 0;
};

// Uploaded examples.
class ExampleStore {
  public:
    struct Row {
        std::string id;
        std::string name;
        std::string digest;  // of the JSON text
    };

    virtual ~ExampleStore() = default;

    // Keeps the example; one of that id stays as it is, and is the owner's too from now on. Fails:
    // kConflict when the digest is not stored, kQueueFull when count_max examples are kept.
    [[nodiscard]] virtual Stored<void> add_example(
        const Row& row, const std::string& owner, std::size_t count_max
    ) = 0;
    [[nodiscard]] virtual Stored<Row> find_example(
        const std::string& id, const OwnerFilter& owner
    ) = 0;
    [[nodiscard]] virtual Stored<std::vector<Row>> list_examples(const OwnerFilter& owner) = 0;
    // It is gone when it is nobody's any more, for everybody at once when no owner is named. Fails:
    // kConflict while an unfinished job of the owner uses it.
    [[nodiscard]] virtual Stored<void> erase_example(
        const std::string& id, const OwnerFilter& owner
    ) = 0;
};

}  // namespace modelsynth::server
