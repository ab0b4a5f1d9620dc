#pragma once

#include "proto/job.h"
#include "proto/job_request.h"
#include "proto/limits.h"
#include "proto/problem.h"
#include "server/jobs/caller.h"
#include "server/jobs/capacity.h"
#include "server/jobs/drain_rate.h"
#include "server/jobs/example_analyses.h"
#include "server/jobs/example_library.h"
#include "server/jobs/job_inputs.h"
#include "server/jobs/job_models.h"
#include "server/jobs/job_observer.h"
#include "server/jobs/live_job.h"
#include "server/jobs/preview_keeper.h"
#include "server/jobs/running_jobs.h"
#include "server/jobs/worker.h"
#include "server/store/artifact_store.h"
#include "server/store/event_log.h"
#include "server/store/job_store.h"

#include <spdlog/logger.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace modelsynth::server {

struct JobServiceConfig {
    std::size_t workers = 2;
    std::size_t queue_max = 1000;
    std::size_t examples_max = 1000;
    // Of one owner; with as many that are not delivered its jobs may have none.
    std::size_t webhooks_waiting_max = 1000;
    // Jobs run as long as what they are thought to need has room in it; 0: three quarters of the
    // machine's memory.
    std::uint64_t memory_bytes_max = 0;
    // A job that chooses labels more often is a large one, which takes seconds; one worker is kept
    // for those that are not.
    std::uint64_t large_choices = 20'000'000;
    proto::RequestLimits limits;
    proto::UnixMillis forget_after_expiry_ms = proto::UnixMillis{21} * 24 * 3600 * 1000;
    std::uint64_t artifact_bytes_max = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t disk_free_bytes_min = 0;  // with less no work is taken
};

// How much may run at the same time under that configuration, on this machine.
[[nodiscard]] CapacityLimits capacity_of(const JobServiceConfig& config);

// Everything that can be done with jobs and examples, without a word of HTTP. Owns the worker
// threads. Thread-safe; calls block on the disk and some on the processor, so none is made from a
// network thread.
class JobService {
  public:
    JobService(
        const JobServiceConfig& config,
        JobStore& jobs,
        EventLog& events,
        ExampleStore& examples,
        ArtifactStore& artifacts,
        std::shared_ptr<spdlog::logger> log,
        JobObserver& observer
    );
    // Stops as drain() does that waits for nothing.
    ~JobService();

    JobService(const JobService&) = delete;
    JobService& operator=(const JobService&) = delete;

    [[nodiscard]] proto::Parsed<Submitted> submit(
        std::string_view body,
        const std::string& idempotency_key,
        const Caller& caller,
        const std::string& traceparent
    );

    // Jobs may have webhooks from now on, with URLs that pass the check. Before the first submit().
    void take_webhooks(proto::CheckWebhook check) { check_webhook_ = std::move(check); }

    // Fails: not-found, also when it is none of the caller's. What follows by id takes the id of
    // anybody's job.
    [[nodiscard]] proto::Parsed<proto::Job> find(const std::string& id, const Caller& caller = {});
    [[nodiscard]] proto::Parsed<JobPage> list(const JobQuery& query);
    // Asks for the end; a running job ends within one block.
    [[nodiscard]] proto::Parsed<proto::Job> cancel(const std::string& id);
    [[nodiscard]] proto::Parsed<void> erase(const std::string& id);

    [[nodiscard]] JobModels& models() { return models_; }

    [[nodiscard]] ExampleLibrary& examples() { return examples_; }

    [[nodiscard]] ExampleAnalyses& analyses() { return analyses_; }

    [[nodiscard]] LiveJobs& live() { return live_; }

    [[nodiscard]] EventLog& events() { return events_; }

    [[nodiscard]] ArtifactStore& artifacts() { return artifacts_; }

    // Whether work is taken. Fails: draining, unavailable as check_room(), queue-full: from when
    // the queue is full until a tenth of it is free.
    [[nodiscard]] proto::Parsed<void> check_ready();

    // Whether there is room on the disk for more. Fails: unavailable.
    [[nodiscard]] proto::Parsed<void> check_room() const;

    [[nodiscard]] std::size_t running_count() const { return jobs_in_hand_; }

    // From now on no work is taken and no job begun. Does not block.
    void refuse_work();

    // Refuses work and lets running jobs go on for so long; those that have not ended by then stop
    // at their next block and stay in the store. Returns when the workers have let go.
    void drain(std::chrono::seconds most);

  private:
    void work(const std::stop_token& stop);
    // Waits for a place; whether there is one and not a stop.
    [[nodiscard]] bool take_place(const std::stop_token& stop);
    // Runs the claim; whether this thread still has its place.
    [[nodiscard]] bool run(const WorkerContext& context, const Claim& claim);
    // For a job that is claimed now: workers that have nothing to do help, as far as there are
    // processors for them.
    [[nodiscard]] std::size_t threads_for_a_job();
    // Removes what is no longer kept.
    void keep_house(const std::stop_token& stop);
    // The request of a job to start from; what the new one needs of it goes to `inputs`.
    // Fails: as find() and find_finished().
    [[nodiscard]] proto::Parsed<proto::JobRequest> find_origin(
        const std::string& id,
        std::uint32_t alternative,
        const Caller& caller,
        InheritedInputs& inputs
    );

    JobServiceConfig config_;
    JobStore& jobs_;
    EventLog& events_;
    ArtifactStore& artifacts_;
    std::shared_ptr<spdlog::logger> log_;
    proto::CheckWebhook check_webhook_;  // none: there are no webhooks
    ExampleLibrary examples_;
    ExampleAnalyses analyses_;
    LiveJobs live_;
    PreviewKeeper previews_;
    RunningJobs running_;
    Capacity capacity_;
    DrainRate drain_rate_{DrainRate::Clock::now()};
    Preparations preparations_;
    JobModels models_;
    std::atomic<bool> draining_ = false;
    std::atomic<bool> queue_was_full_ = false;
    std::mutex mutex_;
    std::condition_variable_any queued_;
    std::uint64_t submissions_ = 0;  // guarded by mutex_; tells sleeping workers of news
    std::size_t idle_workers_ = 0;   // guarded by mutex_
    // How many workers there may be at once, of more threads than that: one whose job was told to
    // stop and that lingers with it passes its place on. Guarded by mutex_.
    std::size_t free_places_;
    std::condition_variable_any place_free_;
    std::atomic<std::size_t> jobs_in_hand_ = 0;
    std::condition_variable let_go_;  // of a job in hand
    JobObserver& observer_;
    std::vector<std::jthread> workers_;
    std::condition_variable_any housekeeping_;
    std::jthread housekeeper_;
};

}  // namespace modelsynth::server
