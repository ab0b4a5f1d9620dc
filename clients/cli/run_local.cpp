// The only file of the client that knows the solver.

#include "clients/cli/run_local.h"

#include "clients/cli/interrupt.h"
#include "clients/cli/output_file.h"
#include "clients/cli/progress.h"
#include "clients/cli/request_body.h"
#include "clients/cli/run_report.h"
#include "proto/job_request.h"
#include "proto/problem.h"
#include "solver/examples/built_in.h"
#include "solver/mesh/glb_writer.h"
#include "solver/registry/task.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <stop_token>
#include <thread>
#include <utility>

namespace modelsynth::cli {

namespace {

using Clock = std::chrono::steady_clock;

Failure failure_of(const proto::Problem& problem) {
    return failure_of_problem(proto::to_json(problem));
}

std::optional<Example> find_built_in(const std::string& id) {
    for (const auto& example : examples::built_in()) {
        if (example->name == id) {
            return example;
        }
    }
    return std::nullopt;
}

// Jobs are on servers.
proto::Parsed<proto::JobRequest> find_no_job(const std::string& /*id*/) {
    return tl::unexpected(proto::make_problem("not-found", "there are no jobs here"));
}

std::uint64_t draw_seed() {
    std::random_device device;
    return ((std::uint64_t{device()} << 32U) | device()) & proto::kSeedMax;
}

GlbProfile profile_of(const std::string& name) {
    if (name == "instanced") {
        return GlbProfile::kInstanced;
    }
    return name == "merged" ? GlbProfile::kMerged : GlbProfile::kNodes;
}

class ShowProgress final : public Observer {
  public:
    explicit ShowProgress(ProgressDisplay& display) : display_(display) {}

    void on_start(std::uint32_t blocks_total, std::span<const Label> /*model*/) override {
        display_.start(blocks_total);
    }

    void on_block(const BlockReport& report) override {
        display_.add_block(report.index + 1, report.blocks_total, report.accepted);
    }

  private:
    ProgressDisplay& display_;
};

// Stops the solver when the program is interrupted or the deadline passes.
class Watchdog {
  public:
    explicit Watchdog(std::optional<double> deadline_seconds)
        : thread_([this, deadline_seconds](const std::stop_token& done) {
              watch(done, deadline_seconds);
          }) {}

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

    [[nodiscard]] bool is_past_deadline() const { return is_past_deadline_; }

  private:
    void watch(const std::stop_token& done, std::optional<double> deadline_seconds) {
        const auto began = Clock::now();
        while (!done.stop_requested() && !stop_.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            const std::chrono::duration<double> elapsed = Clock::now() - began;
            is_past_deadline_ = deadline_seconds && elapsed.count() > *deadline_seconds;
            if (is_interrupted() || is_past_deadline_) {
                stop_.request_stop();
            }
        }
    }

    std::stop_source stop_;
    std::atomic<bool> is_past_deadline_ = false;
    std::jthread thread_;  // last, since it uses the others
};

Outcome<Finished> solve(const proto::JobRequest& request, ProgressDisplay& display) {
    ShowProgress observer(display);
    const Watchdog watchdog(request.deadline_seconds);
    Preparations preparations;
    auto finished =
        run(request.task,
            preparations,
            observer,
            watchdog.token(),
            nullptr,
            std::max(1U, std::thread::hardware_concurrency()));
    display.finish();
    if (is_interrupted()) {
        return tl::unexpected(Failure{ExitCode::kInterrupted, "interrupted"});
    }
    if (finished) {
        return std::move(*finished);
    }
    const bool is_late =
        finished.error().code == ErrorCode::kCancelled && watchdog.is_past_deadline();
    return tl::unexpected(failure_of(
        is_late ? proto::make_problem("deadline-exceeded", "the deadline passed while solving")
                : proto::problem_of(finished.error())
    ));
}

// The bytes written.
Outcome<std::uint64_t> write_model(
    const RunOptions& options, const Example& example, const Model& model
) {
    GlbOptions glb_options;
    glb_options.profile = profile_of(options.profile);
    const auto glb = write_glb(make_scene(example, model, Box::whole(model.size)), glb_options);
    if (!glb) {
        return tl::unexpected(failure_of(proto::problem_of(glb.error())));
    }
    OutputFile file(options.output);
    static_cast<void>(file.write(*glb));  // commit() tells whether it went well
    if (is_interrupted()) {
        return tl::unexpected(Failure{ExitCode::kInterrupted, "interrupted"});
    }
    return file.commit().map([&file] { return file.bytes_written(); });
}

}  // namespace

Outcome<void> run_local(const RunOptions& options, bool as_json) {
    if (auto usable = OutputFile::check(options.output); !usable) {
        return usable;
    }
    const auto body = make_request_body(options.request);
    if (!body) {
        return tl::unexpected(body.error());
    }
    const auto request =
        proto::parse_job_request(*body, {}, find_built_in, find_no_job, draw_seed());
    if (!request) {
        return tl::unexpected(failure_of(request.error()));
    }
    ProgressDisplay display(choose_style(as_json));
    const auto finished = solve(*request, display);
    if (!finished) {
        return tl::unexpected(finished.error());
    }
    return write_model(options, request->task.example, finished->model)
        .map([&](std::uint64_t bytes) {
            print_report(
                {"",
                 options.output,
                 bytes,
                 request->task.seed,
                 display.progress(),
                 display.elapsed()},
                as_json
            );
        });
}

}  // namespace modelsynth::cli
