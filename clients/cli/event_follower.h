#pragma once

#include "clients/cli/failure.h"
#include "clients/cli/http_client.h"
#include "clients/cli/job_event.h"

#include <cstdint>
#include <functional>
#include <string>

namespace modelsynth::cli {

using EventHandler = std::function<void(const JobEvent& event)>;

// Reads a job's events after `after` until the job ends. Whatever happens to the connections,
// the handler gets every event once and in order: a broken one is taken up again after the last
// event that came, a few times and ever more slowly.
// Fails: kUnreachable when that is of no use, kFailed for a problem answer such as an unknown job,
//        kInterrupted.
[[nodiscard]] Outcome<JobEnd> follow_job(
    const HttpClient& client,
    const std::string& job_id,
    std::uint64_t after,
    const EventHandler& on_event
);

}  // namespace modelsynth::cli
