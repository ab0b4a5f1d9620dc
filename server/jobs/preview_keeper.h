#pragma once

#include "proto/job.h"
#include "server/jobs/live_job.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"

#include <spdlog/logger.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

namespace modelsynth::server {

// Puts on disk what there is of the models of jobs that ended without one, on a thread of its own:
// megabytes, which no worker that was told to stop shall wait for. Until that is done the live
// model is the job's preview, and after a crash in between its last checkpoint. Thread-safe.
class PreviewKeeper {
  public:
    // All outlive it.
    PreviewKeeper(
        JobStore& jobs,
        ArtifactStore& artifacts,
        LiveJobs& live,
        std::shared_ptr<spdlog::logger> log
    );
    // Returns when what was handed over is kept.
    ~PreviewKeeper();

    PreviewKeeper(const PreviewKeeper&) = delete;
    PreviewKeeper& operator=(const PreviewKeeper&) = delete;

    // An ended job whose live model is there; it is retired once it is kept. Waits only while
    // kWaitingMax others do.
    void keep(proto::Job job);

    static constexpr std::size_t kWaitingMax = 8;

  private:
    void work(const std::stop_token& stop);
    void keep_now(const proto::Job& job);

    JobStore& jobs_;
    ArtifactStore& artifacts_;
    LiveJobs& live_;
    std::shared_ptr<spdlog::logger> log_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::deque<proto::Job> waiting_;  // guarded by mutex_
    std::jthread thread_;
};

}  // namespace modelsynth::server
