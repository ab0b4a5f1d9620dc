#include "server/jobs/worker.h"

#include "proto/frame.h"
#include "proto/job_request.h"
#include "proto/timestamp.h"
#include "server/jobs/job_inputs.h"
#include "server/jobs/logging_observer.h"
#include "server/jobs/store_problem.h"
#include "solver/mesh/glb_writer.h"

#include <chrono>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace {

using Clock = std::chrono::steady_clock;

// One claim in hand.
class ClaimRun {
  public:
    ClaimRun(const WorkerContext& context, const Claim& claim, std::uint32_t threads)
        : context_(context),
          claim_(claim),
          threads_(threads),
          running_(context.running, claim.lease.job_id) {}

    void run() {
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
        solve(request->task);
    }

  private:
    void solve(const Task& task) {
        const auto live = std::make_shared<LiveJob>(task.example, model_size(task.parameters));
        context_.live.add(claim_.lease.job_id, live);
        if (claim_.deadline_seconds) {
            const std::chrono::duration<double> left(
                *claim_.deadline_seconds - claim_.solved_seconds
            );
            running_.set_deadline(Clock::now() + std::chrono::duration_cast<Clock::duration>(left));
        }
        const EarlierProgress earlier =
            read_earlier_progress(context_.events, claim_, live->size().cell_count());
        LoggingObserver observer(
            context_.jobs,
            context_.running,
            claim_,
            [this](StopReason reason) { running_.request_stop(reason); },
            live,
            earlier
        );
        const auto begun = Clock::now();
        const Checkpoint* from = earlier.checkpoint ? &*earlier.checkpoint : nullptr;
        auto finished = modelsynth::run(
            task, context_.preparations, observer, running_.token(), from, threads_
        );
        const std::chrono::duration<double> solving = Clock::now() - begun;
        if (observer.diverged()) {
            context_.log->error(
                "resumed job differs from its log job={} version={}",
                claim_.lease.job_id,
                kSolverVersion
            );
            fail(proto::make_problem(
                "internal", "solving the job again after a restart gave another model"
            ));
        } else if (finished) {
            succeed(task, *finished, solving.count());
        } else {
            stopped_or_failed(finished.error(), *live, observer.solved_seconds());
        }
        context_.live.retire(claim_.lease.job_id);
    }

    void succeed(const Task& task, const Finished& finished, double solve_seconds) {
        const Box whole = Box::whole(finished.model.size);
        auto glb = write_glb(make_scene(task.example, finished.model, whole));
        if (!glb) {
            fail(proto::problem_of(glb.error()));
            return;
        }
        const auto model_pin = context_.artifacts.put(*glb);
        const auto labels_pin = context_.artifacts.put(proto::encode_labels(finished.model.labels));
        if (!model_pin || !labels_pin) {
            fail(problem_of(model_pin ? labels_pin.error() : model_pin.error()));
            return;
        }
        Outcome outcome;
        outcome.state = proto::JobState::kSucceeded;
        outcome.result = proto::to_json(proto::JobResult{
            claim_.lease.job_id,
            glb->size(),
            (*model_pin)->digest(),
            finished.stats,
            solve_seconds,
            finished.model.size});
        outcome.artifacts = {
            {"nodes.glb", (*model_pin)->digest()}, {"labels", (*labels_pin)->digest()}};
        link_example(outcome);
        finish(std::move(outcome));
    }

    void stopped_or_failed(const Error& error, const LiveJob& live, double solved_seconds) {
        if (error.code != ErrorCode::kCancelled) {
            end_unfinished(proto::JobState::kFailed, proto::problem_of(error), live);
            return;
        }
        switch (running_.reason()) {
            case StopReason::kDraining:
                static_cast<void>(context_.jobs.release(claim_.lease, solved_seconds));
                return;
            case StopReason::kDeadline:
                end_unfinished(
                    proto::JobState::kFailed,
                    proto::make_problem(
                        "deadline-exceeded",
                        "the job was solving for longer than its deadline of " +
                            std::to_string(*claim_.deadline_seconds) + " seconds"
                    ),
                    live
                );
                return;
            case StopReason::kLost:
                // Erased, or the store cannot be written: then the next start takes it up again.
                static_cast<void>(context_.jobs.release(claim_.lease, solved_seconds));
                return;
            case StopReason::kCancelled:
            case StopReason::kNone:
                end_unfinished(proto::JobState::kCancelled, std::nullopt, live);
                return;
        }
    }

    // An uploaded example may be deleted while the job's model is kept; what the model's other
    // profiles are made from stays with the job.
    void link_example(Outcome& outcome) const {
        if (!example_digest_.empty()) {
            outcome.artifacts.push_back({kExampleArtifact, example_digest_});
        }
    }

    // Ends the job with what there is of its model as its preview.
    void end_unfinished(
        proto::JobState state, const std::optional<proto::Problem>& problem, const LiveJob& live
    ) {
        Outcome outcome;
        outcome.state = state;
        if (problem) {
            outcome.error = proto::to_json(*problem);
        }
        const LiveJob::State preview = live.state();
        std::optional<Stored<std::unique_ptr<ArtifactStore::Pin>>> pin;
        if (preview.any_block) {
            pin = context_.artifacts.put(proto::encode_labels(preview.model.labels));
            if (*pin) {
                outcome.artifacts = {{"labels", (**pin)->digest()}};
                link_example(outcome);
            }
        }
        finish(std::move(outcome));
    }

    void fail(const proto::Problem& problem) {
        Outcome outcome;
        outcome.state = proto::JobState::kFailed;
        outcome.error = proto::to_json(problem);
        finish(std::move(outcome));
    }

    void finish(Outcome outcome) {
        outcome.finished = proto::now_millis();
        const auto job = context_.jobs.finish(claim_.lease, outcome);
        if (job) {
            context_.log->info("job ended job={} state={}", job->id, proto::state_name(job->state));
        } else if (job.error().code != StoreErrorCode::kLeaseLost) {
            context_.log->error(
                "job cannot be ended job={} why=\"{}\"", claim_.lease.job_id, job.error().message
            );
            static_cast<void>(context_.jobs.release(claim_.lease, claim_.solved_seconds));
        }
    }

    const WorkerContext& context_;
    const Claim& claim_;
    std::uint32_t threads_;
    RunningJobs::Entry running_;
    std::string example_digest_;  // of an uploaded example's text
};

}  // namespace

void run_claim(const WorkerContext& context, const Claim& claim, std::uint32_t threads) {
    try {
        ClaimRun(context, claim, threads).run();
    } catch (const std::exception& error) {
        context.log->error("job threw job={} what=\"{}\"", claim.lease.job_id, error.what());
        Outcome outcome;
        outcome.state = proto::JobState::kFailed;
        outcome.error =
            proto::to_json(proto::make_problem("internal", "the job ran into a fault of the server")
            );
        outcome.finished = proto::now_millis();
        static_cast<void>(context.jobs.finish(claim.lease, outcome));
    }
    context.running.settle(claim.lease.job_id);
}

}  // namespace modelsynth::server
