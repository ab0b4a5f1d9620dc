#include "server/jobs/worker.h"

#include "proto/frame.h"
#include "proto/job_request.h"
#include "server/jobs/ids.h"
#include "server/jobs/store_problem.h"
#include "solver/mesh/glb_writer.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace {

using Clock = std::chrono::steady_clock;

struct LoggedBlock {
    std::uint64_t seq = 0;
    std::string fields;
};

// Turns what the solver tells into events and patches.
class LoggingObserver final : public Observer {
  public:
    LoggingObserver(
        const WorkerContext& context,
        const Claim& claim,
        RunningJobs::Entry& running,
        std::shared_ptr<LiveJob> live,
        std::vector<LoggedBlock> logged
    )
        : context_(context),
          claim_(claim),
          running_(running),
          live_(std::move(live)),
          logged_(std::move(logged)) {
        start_->first_logged = logged_.empty() ? 0 : logged_.front().seq;
    }

    void on_start(std::uint32_t blocks_total, std::span<const Label> initial) override {
        blocks_total_ = blocks_total;
        const bool resumed = !claim_.solver_version.empty();
        auto labels = std::make_shared<std::vector<Label>>(initial.begin(), initial.end());
        append(
            {"started", proto::started_fields(blocks_total, resumed), now_millis()},
            static_cast<std::uint32_t>(logged_.size()),
            [start = start_, live = live_, labels](std::uint64_t seq) {
                // What is solved again after a restart belongs to the seqs that it had.
                live->start(start->first_logged > 0 ? start->first_logged - 1 : seq, *labels);
                start->seq = seq;
            }
        );
    }

    void on_block(const BlockReport& report) override {
        std::string fields = proto::block_fields(report);
        std::shared_ptr<Patch> patch = report.accepted ? make_patch(report) : nullptr;
        if (report.index < logged_.size()) {
            replay(logged_[report.index], fields, std::move(patch));
            return;
        }
        append(
            {"block", std::move(fields), now_millis()},
            report.index + 1,
            [live = live_, patch](std::uint64_t seq) { show(*live, patch, seq); }
        );
    }

    // How long this claim has been solving, and the ones before it.
    [[nodiscard]] double solved_seconds() const {
        const std::chrono::duration<double> own = Clock::now() - begun_;
        return claim_.solved_seconds + own.count();
    }

    [[nodiscard]] bool diverged() const { return diverged_; }

  private:
    static void show(LiveJob& live, const std::shared_ptr<Patch>& patch, std::uint64_t seq) {
        if (patch == nullptr) {
            live.pass(seq);
            return;
        }
        patch->seq = seq;
        live.apply(patch);
    }

    [[nodiscard]] std::shared_ptr<Patch> make_patch(const BlockReport& report) const {
        auto patch = std::make_shared<Patch>();
        patch->region = report.region;
        patch->labels.reserve(report.region.size().cell_count());
        const GridSize size = live_size_;
        for_each_cell(report.region, [&](const Cell& cell) {
            patch->labels.push_back(report.model[size.index(cell)]);
        });
        return patch;
    }

    // A block that the log holds: shown again, and checked against what was logged.
    void replay(
        const LoggedBlock& logged, const std::string& fields, std::shared_ptr<Patch> patch
    ) {
        if (logged.fields != fields) {
            diverged_ = true;
            running_.request_stop(StopReason::kLost);
            return;
        }
        // In order with the blocks still to be appended, so through the store's queue as well.
        const bool last = &logged == &logged_.back();
        append_nothing(
            [live = live_, patch = std::move(patch), seq = logged.seq, last, start = start_] {
                show(*live, patch, seq);
                if (last) {
                    live->pass(start->seq);
                }
            }
        );
    }

    void append(
        NewEvent event, std::uint32_t blocks_done, std::function<void(std::uint64_t)> then
    ) {
        std::vector<NewEvent> events;
        events.push_back(std::move(event));
        post(std::move(events), blocks_done, std::move(then));
    }

    void append_nothing(std::function<void()> then) {
        post(
            {},
            static_cast<std::uint32_t>(logged_.size()),
            [then = std::move(then)](std::uint64_t) { then(); }
        );
    }

    void post(
        std::vector<NewEvent> events,
        std::uint32_t blocks_done,
        std::function<void(std::uint64_t)> then
    ) {
        context_.jobs.append(
            claim_.lease,
            std::move(events),
            {blocks_done, blocks_total_, solved_seconds(), kSolverVersion},
            [&running = context_.running,
             id = claim_.lease.job_id,
             then = std::move(then)](const Stored<std::uint64_t>& seq) {
                if (seq) {
                    then(*seq);
                } else {
                    running.stop(id, StopReason::kLost);
                }
            }
        );
    }

    const WorkerContext& context_;
    const Claim& claim_;
    RunningJobs::Entry& running_;
    std::shared_ptr<LiveJob> live_;
    GridSize live_size_ = live_->size();
    std::vector<LoggedBlock> logged_;

    // Where this claim begins in the log; known once it is written, on the store's thread.
    struct Start {
        std::uint64_t seq = 0;           // of its `started` event
        std::uint64_t first_logged = 0;  // seq of the first block logged before; 0: none
    };

    std::shared_ptr<Start> start_ = std::make_shared<Start>();
    std::uint32_t blocks_total_ = 0;
    bool diverged_ = false;
    Clock::time_point begun_ = Clock::now();
};

// The block events in the log, when they were made by this version of the solver.
std::vector<LoggedBlock> read_logged_blocks(const WorkerContext& context, const Claim& claim) {
    std::vector<LoggedBlock> blocks;
    if (claim.solver_version != kSolverVersion) {
        return blocks;
    }
    constexpr std::size_t kPage = 1000;
    std::uint64_t after = 0;
    while (after < claim.head) {
        const auto page = context.events.read(claim.lease.job_id, after, kPage);
        if (!page || page->events.empty()) {
            break;
        }
        for (const Event& event : page->events) {
            if (event.type == "block") {
                blocks.push_back({event.seq, event.fields});
            }
            after = event.seq;
        }
    }
    return blocks;
}

// One claim in hand.
class ClaimRun {
  public:
    ClaimRun(const WorkerContext& context, const Claim& claim)
        : context_(context), claim_(claim), running_(context.running, claim.lease.job_id) {}

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
                auto entry = context_.examples.find(id);
                example_digest_ = entry ? entry->digest : "";
                return entry ? std::optional(std::move(entry->example)) : std::nullopt;
            },
            claim_.job.seed
        );
        if (!request) {
            fail(request.error());
            return;
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
        LoggingObserver observer(
            context_, claim_, running_, live, read_logged_blocks(context_, claim_)
        );
        const auto begun = Clock::now();
        auto finished = modelsynth::run(task, observer, running_.token());
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
        outcome.finished = now_millis();
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
    RunningJobs::Entry running_;
    std::string example_digest_;  // of an uploaded example's text
};

}  // namespace

void run_claim(const WorkerContext& context, const Claim& claim) {
    try {
        ClaimRun(context, claim).run();
    } catch (const std::exception& error) {
        context.log->error("job threw job={} what=\"{}\"", claim.lease.job_id, error.what());
        Outcome outcome;
        outcome.state = proto::JobState::kFailed;
        outcome.error =
            proto::to_json(proto::make_problem("internal", "the job ran into a fault of the server")
            );
        outcome.finished = now_millis();
        static_cast<void>(context.jobs.finish(claim.lease, outcome));
    }
    context.running.settle(claim.lease.job_id);
}

}  // namespace modelsynth::server
