#include "server/jobs/job_service.h"

#include "server/jobs/ids.h"
#include "server/jobs/store_problem.h"
#include "solver/registry/estimate.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace modelsynth::server {

namespace {

using proto::Job;
using proto::JobState;
using proto::make_problem;
using proto::Parsed;

// What a job of no labels costs, in choices of labels: it is read, logged, kept and sent all the
// same.
constexpr std::uint64_t kJobCost = 1000;

// Threads beyond the places for workers are those that may linger with jobs that were stopped.
constexpr std::size_t kThreadsPerPlace = 4;

// The calling thread, and those that it starts, leave the processor to threads that answer, which
// need it for fractions of a millisecond. Where that is forbidden, answers wait a little longer.
void give_way() {
    constexpr int kNicer = 5;
    [[maybe_unused]] const int niceness = ::nice(kNicer);
}

}  // namespace

CapacityLimits capacity_of(const JobServiceConfig& config) {
    CapacityLimits limits;
    limits.memory_bytes = config.memory_bytes_max;
    if (limits.memory_bytes == 0) {
        limits.memory_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                              static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE)) / 4 * 3;
    }
    // What costs nothing is the least that a job costs.
    limits.large_cost = kJobCost + config.large_choices;
    limits.large_jobs = std::max<std::size_t>(1, config.workers - 1);
    return limits;
}

JobService::JobService(
    const JobServiceConfig& config,
    JobStore& jobs,
    EventLog& events,
    ExampleStore& examples,
    ArtifactStore& artifacts,
    std::shared_ptr<spdlog::logger> log,
    JobObserver& observer
)
    : config_(config),
      jobs_(jobs),
      events_(events),
      artifacts_(artifacts),
      log_(std::move(log)),
      examples_(examples, artifacts, config_.limits, config.examples_max),
      previews_(jobs_, artifacts_, live_, log_),
      capacity_(capacity_of(config)),
      models_(jobs_, artifacts_, examples_, live_, preparations_, config_.limits),
      free_places_(config.workers),
      observer_(observer) {
    for (std::size_t i = 0; i < kThreadsPerPlace * config_.workers; ++i) {
        workers_.emplace_back([this](const std::stop_token& stop) {
            ::pthread_setname_np(::pthread_self(), "worker");
            give_way();
            work(stop);
        });
    }
    housekeeper_ = std::jthread([this](const std::stop_token& stop) { keep_house(stop); });
}

JobService::~JobService() { drain(std::chrono::seconds(0)); }

void JobService::work(const std::stop_token& stop) {
    // A notification is a hint; what is queued is found by looking.
    constexpr auto kPoll = std::chrono::milliseconds(250);
    const WorkerContext context = {
        jobs_,
        events_,
        artifacts_,
        examples_,
        live_,
        previews_,
        running_,
        preparations_,
        config_.limits,
        log_,
        observer_};
    std::uint64_t seen = 0;
    bool has_place = take_place(stop);
    while (has_place && !stop.stop_requested() && !draining_) {
        {
            const std::lock_guard lock(mutex_);
            seen = submissions_;
        }
        const auto claim = capacity_.claim(jobs_, proto::now_millis());
        if (claim && *claim) {
            has_place = run(context, **claim) || take_place(stop);
            continue;
        }
        std::unique_lock lock(mutex_);
        ++idle_workers_;
        queued_.wait_for(lock, stop, kPoll, [&] { return submissions_ != seen || draining_; });
        --idle_workers_;
    }
}

bool JobService::take_place(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    if (!place_free_.wait(lock, stop, [this] { return free_places_ > 0; })) {
        return false;
    }
    --free_places_;
    return true;
}

bool JobService::run(const WorkerContext& context, const Claim& claim) {
    ++jobs_in_hand_;
    bool has_place = true;
    const auto pass_on = [&] {
        capacity_.give_back_turn(claim);
        const std::lock_guard lock(mutex_);
        ++free_places_;
        place_free_.notify_one();
        has_place = false;
    };
    run_claim(context, claim, static_cast<std::uint32_t>(threads_for_a_job()), pass_on);
    if (has_place) {
        capacity_.give_back_turn(claim);
    }
    capacity_.give_back_memory(claim);
    drain_rate_.on_let_go(DrainRate::Clock::now());
    const std::lock_guard lock(mutex_);
    --jobs_in_hand_;
    let_go_.notify_all();
    return has_place;
}

std::size_t JobService::threads_for_a_job() {
    const std::lock_guard lock(mutex_);
    return std::min<std::size_t>(
        config_.workers / (config_.workers - idle_workers_),
        std::max(1U, std::thread::hardware_concurrency())
    );
}

void JobService::keep_house(const std::stop_token& stop) {
    constexpr proto::UnixMillis kInterval = 60'000;
    constexpr auto kPause = std::chrono::seconds(1);
    proto::UnixMillis last = 0;
    std::mutex mutex;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
        const proto::UnixMillis now = proto::now_millis();
        if (now - last >= kInterval) {
            jobs_.expire(now);
            jobs_.forget(now - config_.forget_after_expiry_ms);
            last = now;
        }
        if (artifacts_.space().used_bytes > config_.artifact_bytes_max) {
            jobs_.shed(config_.artifact_bytes_max, now);
        }
        housekeeping_.wait_for(lock, stop, kPause, [] { return false; });
    }
}

Parsed<Submitted> JobService::submit(
    std::string_view body,
    const std::string& idempotency_key,
    const Caller& caller,
    const std::string& traceparent
) {
    // A retry gets its first answer whatever has changed since, so the key comes first.
    std::string request_hash;
    if (!idempotency_key.empty()) {
        const auto canonical = proto::canonical_json(body, config_.limits.json);
        if (!canonical) {
            return tl::unexpected(canonical.error());
        }
        request_hash = sha256_hex(*canonical);
        auto known = jobs_.find_key(caller.owner, idempotency_key, request_hash);
        if (!known) {
            return tl::unexpected(problem_of(known.error()));
        }
        if (*known) {
            return Submitted{std::move(**known), true};
        }
    }
    if (draining_) {
        return tl::unexpected(make_problem("draining", "the server is stopping"));
    }
    if (auto room = check_room(); !room) {
        return tl::unexpected(std::move(room.error()));
    }
    InheritedInputs inputs;
    auto request = proto::parse_job_request(
        body,
        config_.limits,
        [&](const std::string& id) -> std::optional<Example> {
            auto entry = examples_.find(id, caller);
            return entry ? std::optional(std::move(entry->example)) : std::nullopt;
        },
        [&](const std::string& id, std::uint32_t alternative) {
            return find_origin(id, alternative, caller, inputs);
        },
        make_seed(),
        check_webhook_
    );
    if (!request) {
        return tl::unexpected(std::move(request.error()));
    }
    const Estimate need = estimate(request->task, request->alternatives.value_or(1));
    if (need.memory_bytes > capacity_.limits().memory_bytes) {
        return tl::unexpected(make_problem(
            "too-large",
            "the job needs about " + std::to_string(need.memory_bytes) +
                " bytes of memory; the limit memory_bytes_max is " +
                std::to_string(capacity_.limits().memory_bytes)
        ));
    }
    NewJob job;
    job.cost = kJobCost + need.choices;
    job.memory_bytes = need.memory_bytes;
    job.created = proto::now_millis();
    job.id = make_job_id(job.created);
    job.owner = caller.owner;
    job.traceparent = traceparent;
    job.webhook = request->webhook;
    job.solver = request->solver;
    job.seed = request->task.seed;
    job.priority = request->priority;
    job.request = request->echo;
    job.example_id = request->example_id;
    job.idempotency_key = idempotency_key;
    job.request_hash = std::move(request_hash);
    job.deadline_seconds = request->deadline_seconds;
    job.artifacts = inputs.links(job.example_id);
    auto submitted =
        jobs_.submit(job, {config_.queue_max, caller.unfinished_max, config_.webhooks_waiting_max});
    if (!submitted) {
        const StoreErrorCode code = submitted.error().code;
        auto problem = problem_of(submitted.error());
        if (code == StoreErrorCode::kQueueFull || code == StoreErrorCode::kOwnerFull) {
            problem.retry_after_seconds = drain_rate_.seconds_to_next(DrainRate::Clock::now());
        }
        return tl::unexpected(std::move(problem));
    }
    if (!submitted->replayed) {
        const std::lock_guard lock(mutex_);
        ++submissions_;
        queued_.notify_one();
    }
    return std::move(*submitted);
}

Parsed<Job> JobService::find(const std::string& id, const Caller& caller) {
    auto job = parsed(jobs_.find(id));
    if (job && !caller.sees_all && job->owner != caller.owner) {
        return tl::unexpected(make_problem("not-found", "there is no job " + id));
    }
    return job;
}

Parsed<JobPage> JobService::list(const JobQuery& query) { return parsed(jobs_.list(query)); }

Parsed<Job> JobService::cancel(const std::string& id) {
    const auto before = jobs_.find(id);
    auto job = jobs_.cancel(id, proto::now_millis());
    if (before && before->state == JobState::kQueued && job && job->state == JobState::kCancelled) {
        observer_.on_ended(job->solver, proto::state_name(job->state), 0);
    }
    if (job && job->state == JobState::kRunning) {
        running_.stop(id, StopReason::kCancelled);
        // The worker may have let go between the two calls; then nobody would take this back.
        const auto now = jobs_.find(id);
        if (!now || proto::is_ended(now->state)) {
            running_.settle(id);
        }
    }
    return parsed(std::move(job));
}

Parsed<void> JobService::erase(const std::string& id) {
    const auto job = jobs_.find(id);
    auto erased = jobs_.erase(id);
    if (job && job->state == JobState::kRunning) {
        running_.stop(id, StopReason::kErased);
        running_.settle(id);  // ids are never used again, so nothing will ask
    }
    live_.forget(id);
    return parsed(std::move(erased));
}

Parsed<proto::JobRequest> JobService::find_origin(
    const std::string& id, std::uint32_t alternative, const Caller& caller, InheritedInputs& inputs
) {
    if (auto visible = find(id, caller); !visible) {
        return tl::unexpected(std::move(visible.error()));
    }
    const auto job = models_.find_finished(id);
    if (!job) {
        return tl::unexpected(job.error());
    }
    const auto taken = inputs.take(jobs_, artifacts_, id, alternative);
    return taken ? models_.read_request(*job) : tl::unexpected(problem_of(taken.error()));
}

Parsed<void> JobService::check_room() const {
    if (artifacts_.space().free_bytes < config_.disk_free_bytes_min) {
        return tl::unexpected(make_problem("unavailable", "the disk is nearly full"));
    }
    return {};
}

Parsed<void> JobService::check_ready() {
    if (draining_) {
        return tl::unexpected(make_problem("draining", "the server is stopping"));
    }
    if (auto room = check_room(); !room) {
        return room;
    }
    const auto queued = jobs_.queued_count();
    if (!queued) {
        return tl::unexpected(problem_of(queued.error()));
    }
    const std::size_t most = config_.queue_max - 1;
    queue_was_full_ = *queued > (queue_was_full_ ? most - most / 10 : most);
    if (queue_was_full_) {
        auto problem = make_problem("queue-full", "the queue is full");
        problem.retry_after_seconds = drain_rate_.seconds_to_next(DrainRate::Clock::now());
        return tl::unexpected(std::move(problem));
    }
    return {};
}

void JobService::refuse_work() {
    draining_ = true;
    queued_.notify_all();
}

void JobService::drain(std::chrono::seconds most) {
    refuse_work();
    {
        std::unique_lock lock(mutex_);
        let_go_.wait_for(lock, most, [this] { return jobs_in_hand_ == 0; });
    }
    analyses_.stop();
    for (std::jthread& worker : workers_) {
        worker.request_stop();
    }
    queued_.notify_all();
    // RunningJobs stops what is in hand and what is taken in hand from now on.
    running_.stop_all(StopReason::kDraining);
    for (std::jthread& worker : workers_) {
        if (worker.joinable()) {
            worker.join();
        }
    }
    housekeeper_.request_stop();
    if (housekeeper_.joinable()) {
        housekeeper_.join();
    }
}

}  // namespace modelsynth::server
