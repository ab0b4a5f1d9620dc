#pragma once

#include "server/store/types.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::server {

// What JobStore and EventLog mean, in memory and as plainly as possible: the oracle for random
// operations. Knows nothing of files; artifacts are digests that are stored or not.
class StoreModel {
  public:
    struct Row {
        proto::Job job;
        NewJob submitted;
        std::uint64_t turn = 0;
        bool cancel_requested = false;
        std::uint64_t token = 0;
        std::uint32_t fruitless_claims = 0;
        bool has_gap = false;  // an append under the lease failed
        double solved_seconds = 0;
        std::string solver_version;
        std::uint64_t version_base = 0;
        std::optional<JobCheckpoint> checkpoint;
        std::map<std::string, std::string> artifacts;
        std::vector<Event> events;
    };

    StoreModel(std::set<std::string> stored_digests, proto::UnixMillis retention_ms)
        : stored_digests_(std::move(stored_digests)), retention_ms_(retention_ms) {}

    [[nodiscard]] Stored<Submitted> submit(const NewJob& job, const QueueLimits& limits);
    [[nodiscard]] std::optional<Claim> claim(proto::UnixMillis now, const ClaimLimits& limits);
    [[nodiscard]] Stored<std::uint64_t> append(
        const Lease& lease, const std::vector<NewEvent>& events, const Progress& progress
    );
    [[nodiscard]] Stored<proto::Job> finish(const Lease& lease, const Outcome& outcome);
    [[nodiscard]] Stored<void> release(const Lease& lease, double solved_seconds);
    [[nodiscard]] Stored<proto::Job> cancel(const std::string& id, proto::UnixMillis now);
    [[nodiscard]] Stored<void> erase(const std::string& id);
    [[nodiscard]] Stored<void> link(const std::string& id, const ArtifactLink& link);
    void expire(proto::UnixMillis now);
    void reopen();

    [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }  // in order of arrival

    [[nodiscard]] const Row* find(const std::string& id) const;

  private:
    Row* held(const Lease& lease);
    // Owner and priority.
    using Flow = std::pair<std::string, std::int32_t>;

    static Flow flow_of(const NewJob& job) { return {job.owner, job.priority}; }

    [[nodiscard]] std::int64_t level(const NewJob& job, proto::UnixMillis now) const;
    [[nodiscard]] bool goes_before(const Row& one, const Row& other, proto::UnixMillis now) const;
    void end(Row& row, proto::JobState state, NewEvent event);

    std::set<std::string> stored_digests_;
    proto::UnixMillis retention_ms_;
    std::vector<Row> rows_;
    std::map<Flow, proto::UnixMillis> served_;  // when it was last
    std::uint64_t turn_ = 0;                    // that is being served
};

}  // namespace modelsynth::server
