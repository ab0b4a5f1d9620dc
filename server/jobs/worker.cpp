#include "server/jobs/worker.h"

#include "proto/frame.h"
#include "proto/job_request.h"
#include "proto/timestamp.h"
#include "server/jobs/job_inputs.h"
#include "server/jobs/logging_observer.h"
#include "server/jobs/store_problem.h"
#include "server/log/event_line.h"
#include "server/store/artifact_names.h"
#include "solver/mesh/glb_writer.h"
#include "solver/registry/alternatives.h"

#include <chrono>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace {

using Clock = std::chrono::steady_clock;

void report_end(const WorkerContext& context, const proto::Job& job, double seconds) {
    const std::string_view state = proto::state_name(job.state);
    context.observer.on_ended(job.solver, state, seconds);
    log_event(
        *context.log,
        spdlog::level::info,
        "job ended",
        {{"job", job.id},
         {"state", state},
         {"solver", job.solver},
         {"seconds", seconds},
         {"blocks_done", job.blocks_done},
         {"traceparent", job.traceparent}}
    );
}

// A problem as it stands in the job, which is where it occurred.
std::string problem_text(const Claim& claim, proto::Problem problem) {
    problem.instance = "/v1/jobs/" + claim.lease.job_id;
    return proto::to_json(problem);
}

// One claim in hand.
class ClaimRun {
  public:
    ClaimRun(
        const WorkerContext& context,
        const Claim& claim,
        std::uint32_t threads,
        std::function<void()> on_lingering
    )
        : context_(context),
          claim_(claim),
          threads_(threads),
          running_(context.running, claim.lease.job_id, std::move(on_lingering)) {}

    void run() {
        const proto::Job& job = claim_.job;
        if (claim_.solver_version.empty() && job.started) {
            context_.observer.on_started(static_cast<double>(*job.started - job.created) / 1000);
        }
        log_event(
            *context_.log,
            spdlog::level::info,
            "job started",
            {{"job", job.id},
             {"solver", job.solver},
             {"threads", threads_},
             {"blocks_done", job.blocks_done},
             {"traceparent", job.traceparent}}
        );
        if (claim_.fruitless_claims >= kFruitlessClaimsMax) {
            fail(proto::make_problem(
                "crashed",
                "the server stopped " + std::to_string(claim_.fruitless_claims) +
                    " times at the same place of this job"
            ));
            return;
        }
        auto request = proto::parse_job_request(
            claim_.job.request,
            context_.limits,
            [this](const std::string& id) -> std::optional<Example> {
                auto entry =
                    find_example(context_.jobs, context_.examples, claim_.lease.job_id, id);
                example_digest_ = entry ? entry->digest : "";
                example_name_ = entry && entry->built_in ? id : "uploaded";
                return entry ? std::optional(std::move(entry->example)) : std::nullopt;
            },
            nullptr,
            claim_.job.seed
        );
        if (!request) {
            fail(request.error());
            return;
        }
        if (request->from) {
            auto origin = load_origin(
                context_.jobs, context_.artifacts, claim_.lease.job_id, request->from->origin
            );
            if (!origin) {
                fail(origin.error());
                return;
            }
            request->task.origin = std::move(*origin);
        }
        solve(*request);
    }

  private:
    // A model that is on disk, held until it is linked to the job.
    struct Kept {
        proto::JobResult result;
        std::vector<ArtifactLink> links;
        std::vector<std::shared_ptr<ArtifactStore::Pin>> pins;
    };

    void solve(const proto::JobRequest& request) {
        if (claim_.deadline_seconds) {
            const std::chrono::duration<double> left(
                *claim_.deadline_seconds - claim_.solved_seconds
            );
            running_.set_deadline(Clock::now() + std::chrono::duration_cast<Clock::duration>(left));
        }
        auto space = space_of(
            request.task.example, request.task.parameters, context_.preparations, running_.token()
        );
        if (!space) {
            stopped_or_failed(space.error(), seconds());
            return;
        }
        live_ = std::make_shared<LiveJob>(std::move(*space));
        context_.live.add(claim_.lease.job_id, live_);
        if (request.alternatives) {
            make_several(request.task, *request.alternatives);
        } else {
            make_one(request.task);
        }
        if (!is_preview_kept_) {
            context_.live.retire(claim_.lease.job_id);
        }
    }

    void make_one(const Task& task) {
        const EarlierProgress earlier =
            read_earlier_progress(context_.events, claim_, live_->space().site_count(), false);
        LoggingObserver observer = make_observer(earlier, {});
        auto kept = make(task, earlier, observer, std::nullopt);
        if (!kept) {
            return;
        }
        if (!*kept) {
            stopped_or_failed(kept->error(), observer.solved_seconds());
            return;
        }
        Outcome outcome;
        outcome.state = proto::JobState::kSucceeded;
        outcome.result = proto::to_json((*kept)->result);
        outcome.artifacts = std::move((*kept)->links);
        finish(std::move(outcome));
    }

    // Candidates one after another until there are as many different models as wanted; each is
    // logged and linked to the job when it is there.
    void make_several(Task task, std::uint32_t wanted) {
        EarlierProgress earlier =
            read_earlier_progress(context_.events, claim_, live_->space().site_count(), true);
        Alternatives series(task.seed, wanted);
        std::vector<std::string> results;
        for (const proto::CandidateEnd& end : earlier.candidates) {
            take_earlier(end, series, results);
        }
        ModelInSeries place;
        place.blocks_before = earlier.candidate_blocks;
        while (!series.is_complete()) {
            place.alternative = series.made();
            place.models_left = wanted - series.made();
            task.seed = series.next_seed();
            proto::CandidateEnd end = {series.candidates(), series.made(), task.seed, {}, {}, {}};
            LoggingObserver observer = make_observer(earlier, place);
            auto kept =
                make(task, earlier, observer, proto::JobResult::Place{end.alternative, end.seed});
            if (!kept) {
                return;
            }
            if (*kept) {
                end.same = series.add((*kept)->result.sha256);
                end.result = end.same ? "" : proto::to_json((*kept)->result);
            } else {
                const bool goes_on = series.add_failure(kept->error().code);
                if (!goes_on && (results.empty() || kept->error().code != ErrorCode::kGaveUp)) {
                    stopped_or_failed(kept->error(), observer.solved_seconds());
                    return;
                }
                end.error = problem_text(claim_, proto::problem_of(kept->error()));
            }
            if (end.result.empty()) {
                observer.end_candidate(end, {}, {}, series.is_complete());
            } else {
                results.push_back(end.result);
                observer.end_candidate(
                    end, std::move((*kept)->links), std::move((*kept)->pins), series.is_complete()
                );
            }
            place.blocks_before += observer.blocks_done();
            place.begins_claim = false;
            earlier = {};
        }
        Outcome outcome;
        outcome.state = proto::JobState::kSucceeded;
        outcome.result = proto::to_json(results);
        finish(std::move(outcome));
    }

    // What became of a candidate before this claim.
    static void take_earlier(
        const proto::CandidateEnd& end, Alternatives& series, std::vector<std::string>& results
    ) {
        if (!end.result.empty()) {
            static_cast<void>(series.add(proto::result_digest(end.result)));
            results.push_back(end.result);
        } else if (end.same) {
            static_cast<void>(series.add(proto::result_digest(results.at(*end.same))));
        } else {
            static_cast<void>(series.add_failure(ErrorCode::kGaveUp));
        }
    }

    LoggingObserver make_observer(const EarlierProgress& earlier, const ModelInSeries& place) {
        return {
            context_.jobs,
            context_.running,
            claim_,
            [this](StopReason reason) { running_.request_stop(reason); },
            live_,
            earlier,
            place,
            [this](bool accepted) { context_.observer.on_block(example_name_, accepted); }};
    }

    // A model of the task's seed, on disk, or why there is none; nothing when the job has ended
    // by it.
    std::optional<Result<Kept>> make(
        const Task& task,
        const EarlierProgress& earlier,
        LoggingObserver& observer,
        const std::optional<proto::JobResult::Place>& place
    ) {
        const auto begun = Clock::now();
        const Checkpoint* from = earlier.checkpoint ? &*earlier.checkpoint : nullptr;
        auto finished = modelsynth::run(
            task, context_.preparations, observer, running_.token(), from, threads_
        );
        const std::chrono::duration<double> solving = Clock::now() - begun;
        if (observer.diverged()) {
            log_event(
                *context_.log,
                spdlog::level::err,
                "resumed job differs from its log",
                {{"job", claim_.lease.job_id},
                 {"version", kSolverVersion},
                 {"traceparent", claim_.job.traceparent}}
            );
            fail(proto::make_problem(
                "internal", "solving the job again after a restart gave another model"
            ));
            return std::nullopt;
        }
        if (!finished) {
            return tl::unexpected(std::move(finished.error()));
        }
        auto glb = write_glb(whole_scene(finished->model));
        if (!glb) {
            return tl::unexpected(std::move(glb.error()));
        }
        auto kept = keep(*glb, *finished, place);
        if (!kept) {
            fail(problem_of(kept.error()));
            return std::nullopt;
        }
        kept->result.solve_seconds = solving.count();
        return std::move(*kept);
    }

    Stored<Kept> keep(
        const std::string& glb,
        const Finished& finished,
        const std::optional<proto::JobResult::Place>& place
    ) {
        const std::uint32_t alternative = place ? place->alternative : 0;
        Kept kept;
        const auto put = [&](const std::string& name, const std::string& bytes) -> Stored<void> {
            return context_.artifacts.put(bytes).map([&](std::unique_ptr<ArtifactStore::Pin> pin) {
                kept.links.push_back({name, pin->digest()});
                kept.pins.push_back(std::move(pin));
            });
        };
        auto stored = put(model_artifact("nodes", alternative), glb).and_then([&] {
            return put(labels_artifact(alternative), proto::encode_labels(finished.model.labels));
        });
        if (!stored) {
            return tl::unexpected(std::move(stored.error()));
        }
        kept.result = {
            claim_.lease.job_id,
            glb.size(),
            kept.links.front().digest,
            finished.stats,
            0,
            finished.model.space->size(),
            finished.model.space->is_grid(),
            place};
        link_example(kept.links);
        return kept;
    }

    void stopped_or_failed(const Error& error, double solved_seconds) {
        if (error.code != ErrorCode::kCancelled) {
            end_unfinished(proto::JobState::kFailed, proto::problem_of(error));
            return;
        }
        switch (running_.reason()) {
            case StopReason::kDraining:
                release(solved_seconds);
                return;
            case StopReason::kDeadline:
                end_unfinished(
                    proto::JobState::kFailed,
                    proto::make_problem(
                        "deadline-exceeded",
                        "the job was solving for longer than its deadline of " +
                            std::to_string(*claim_.deadline_seconds) + " seconds"
                    )
                );
                return;
            case StopReason::kErased:
            case StopReason::kLost:
                // Where the store cannot be written, the next start takes it up again.
                release(solved_seconds);
                return;
            case StopReason::kCancelled:
            case StopReason::kNone:
                end_unfinished(proto::JobState::kCancelled, std::nullopt);
                return;
        }
    }

    // An uploaded example may be deleted while the job's model is kept; what the model's other
    // profiles are made from stays with the job.
    void link_example(std::vector<ArtifactLink>& links) const {
        if (!example_digest_.empty()) {
            links.push_back({kExampleArtifact, example_digest_});
        }
    }

    // Ends the job; what there is of its model is kept as its preview when the worker is free.
    void end_unfinished(proto::JobState state, const std::optional<proto::Problem>& problem) {
        Outcome outcome;
        outcome.state = state;
        if (problem) {
            outcome.error = problem_text(claim_, *problem);
        }
        link_example(outcome.artifacts);
        auto job = finish(std::move(outcome));
        // Without a live model not even its space was known yet.
        if (job && live_ != nullptr) {
            context_.previews.keep(std::move(*job));
            is_preview_kept_ = true;
        }
    }

    void fail(const proto::Problem& problem) {
        Outcome outcome;
        outcome.state = proto::JobState::kFailed;
        outcome.error = problem_text(claim_, problem);
        finish(std::move(outcome));
    }

    // The job, when it has ended.
    std::optional<proto::Job> finish(Outcome outcome) {
        outcome.finished = proto::now_millis();
        auto job = context_.jobs.finish(claim_.lease, outcome);
        if (job) {
            report_end(context_, *job, seconds());
            return std::move(*job);
        }
        if (job.error().code != StoreErrorCode::kLeaseLost) {
            log_event(
                *context_.log,
                spdlog::level::err,
                "job cannot be ended",
                {{"job", claim_.lease.job_id},
                 {"why", job.error().message},
                 {"traceparent", claim_.job.traceparent}}
            );
            release(claim_.solved_seconds);
        }
        return std::nullopt;
    }

    // Gives the job back. While the disk is full, say, there is no use in other work either, so
    // that is waited for; at the latest the next start of the server takes the job up.
    void release(double solved_seconds) {
        constexpr auto kPause = std::chrono::milliseconds(500);
        auto released = context_.jobs.release(claim_.lease, solved_seconds);
        while (!released && released.error().code == StoreErrorCode::kUnavailable &&
               context_.running.pause(kPause)) {
            released = context_.jobs.release(claim_.lease, solved_seconds);
        }
        const bool is_deleted = !released && released.error().code == StoreErrorCode::kLeaseLost;
        log_event(
            *context_.log,
            released || is_deleted ? spdlog::level::info : spdlog::level::warn,
            is_deleted ? "job deleted" : "job given back",
            {{"job", claim_.lease.job_id},
             {"seconds", seconds()},
             {"why", released ? "" : released.error().message},
             {"traceparent", claim_.job.traceparent}}
        );
    }

    [[nodiscard]] double seconds() const {
        const std::chrono::duration<double> own = Clock::now() - begun_;
        return claim_.solved_seconds + own.count();
    }

    const WorkerContext& context_;
    const Claim& claim_;
    std::uint32_t threads_;
    RunningJobs::Entry running_;
    std::string example_digest_;           // of an uploaded example's text
    std::string example_name_ = "inline";  // as the observer is told
    Clock::time_point begun_ = Clock::now();
    std::shared_ptr<LiveJob> live_;
    bool is_preview_kept_ = false;  // or will be, from the live model
};

}  // namespace

void run_claim(
    const WorkerContext& context,
    const Claim& claim,
    std::uint32_t threads,
    std::function<void()> on_lingering
) {
    try {
        ClaimRun(context, claim, threads, std::move(on_lingering)).run();
    } catch (const std::exception& error) {
        log_event(
            *context.log,
            spdlog::level::err,
            "job threw",
            {{"job", claim.lease.job_id},
             {"what", error.what()},
             {"traceparent", claim.job.traceparent}}
        );
        Outcome outcome;
        outcome.state = proto::JobState::kFailed;
        outcome.error = problem_text(
            claim, proto::make_problem("internal", "the job ran into a fault of the server")
        );
        outcome.finished = proto::now_millis();
        if (const auto job = context.jobs.finish(claim.lease, outcome)) {
            report_end(context, *job, claim.solved_seconds);
        }
    }
    context.running.settle(claim.lease.job_id);
}

}  // namespace modelsynth::server
