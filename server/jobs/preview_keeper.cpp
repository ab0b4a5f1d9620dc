#include "server/jobs/preview_keeper.h"

#include "proto/frame.h"
#include "server/log/event_line.h"
#include "server/store/artifact_names.h"

#include <exception>
#include <string>
#include <string_view>
#include <utility>

namespace modelsynth::server {

namespace {

void report_failure(spdlog::logger& log, const proto::Job& job, std::string_view why) {
    log_event(
        log,
        spdlog::level::warn,
        "preview cannot be kept",
        {{"job", job.id}, {"why", why}, {"traceparent", job.traceparent}}
    );
}

}  // namespace

PreviewKeeper::PreviewKeeper(
    JobStore& jobs, ArtifactStore& artifacts, LiveJobs& live, std::shared_ptr<spdlog::logger> log
)
    : jobs_(jobs),
      artifacts_(artifacts),
      live_(live),
      log_(std::move(log)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

PreviewKeeper::~PreviewKeeper() = default;

void PreviewKeeper::keep(proto::Job job) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kWaitingMax; });
    waiting_.push_back(std::move(job));
    changed_.notify_all();
}

void PreviewKeeper::work(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    // Told to stop, it goes on until nothing waits.
    while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
        const proto::Job job = std::move(waiting_.front());
        lock.unlock();
        try {
            keep_now(job);
        } catch (const std::exception& error) {
            report_failure(*log_, job, error.what());
        }
        live_.retire(job.id);
        lock.lock();
        waiting_.pop_front();
        changed_.notify_all();
    }
}

void PreviewKeeper::keep_now(const proto::Job& job) {
    const auto live = live_.find(job.id);
    if (live == nullptr) {
        return;  // deleted
    }
    const LiveJob::State state = live->state();
    if (!state.any_block) {
        return;
    }
    const auto pin = artifacts_.put(proto::encode_labels(state.model.labels));
    const auto linked =
        pin ? jobs_.link(job.id, {kPreviewArtifact, (*pin)->digest()}) : Stored<void>();
    if (!pin || (!linked && linked.error().code != StoreErrorCode::kNotFound)) {
        report_failure(*log_, job, pin ? linked.error().message : pin.error().message);
    }
}

}  // namespace modelsynth::server
