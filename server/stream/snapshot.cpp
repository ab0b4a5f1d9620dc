#include "server/stream/snapshot.h"

#include "proto/job.h"
#include "proto/timestamp.h"

namespace modelsynth::server {

std::optional<Event> snapshot_after(
    JobService& service, const std::string& job_id, std::uint64_t position
) {
    auto job = service.find(job_id);
    if (!job) {
        return std::nullopt;
    }
    if (proto::is_ended(job->state)) {
        --job->head;
        job->state = proto::JobState::kRunning;
        job->finished.reset();
        job->expires.reset();
        job->result.clear();
        job->error.clear();
    }
    if (job->head <= position + kLagMax) {
        return std::nullopt;
    }
    return Event{
        job->head, "snapshot", proto::snapshot_fields(proto::to_json(*job)), proto::now_millis()};
}

}  // namespace modelsynth::server
