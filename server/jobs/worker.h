#pragma once

#include "proto/limits.h"
#include "server/jobs/example_library.h"
#include "server/jobs/job_observer.h"
#include "server/jobs/live_job.h"
#include "server/jobs/preview_keeper.h"
#include "server/jobs/running_jobs.h"
#include "server/store/artifact_store.h"
#include "server/store/event_log.h"
#include "server/store/job_store.h"

#include <spdlog/logger.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace modelsynth::server {

// A job that was claimed this often in a row without logging anything new is given up: it takes
// the server down with it, or time and again there is none to make it.
inline constexpr std::uint32_t kFruitlessClaimsMax = 8;

// What a worker needs; everything outlives it and is thread-safe.
struct WorkerContext {
    JobStore& jobs;
    EventLog& events;
    ArtifactStore& artifacts;
    ExampleLibrary& examples;
    LiveJobs& live;
    PreviewKeeper& previews;
    RunningJobs& running;
    Preparations& preparations;
    const proto::RequestLimits& limits;
    std::shared_ptr<spdlog::logger> log;
    JobObserver& observer;
};

// Runs one claimed job to its end, or until it is told to stop: solves, logs each block, keeps
// the artifacts, ends the job. A job that was begun before goes on from its checkpoint; since
// solving is deterministic nothing is appended until it passes what the log already holds, and
// what is solved again must equal what was logged. `threads`: how many may solve, this one
// included; they change no result. `on_lingering`: see RunningJobs::Entry. Throws nothing.
void run_claim(
    const WorkerContext& context,
    const Claim& claim,
    std::uint32_t threads = 1,
    std::function<void()> on_lingering = [] {}
);

}  // namespace modelsynth::server
