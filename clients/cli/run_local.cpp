// The only file of the client that knows the solver.

#include "clients/cli/run_local.h"

#include "clients/cli/interrupt.h"
#include "clients/cli/output_file.h"
#include "clients/cli/progress.h"
#include "clients/cli/request_body.h"
#include "clients/cli/run_report.h"
#include "proto/job_request.h"
#include "proto/problem.h"
#include "solver/examples/all.h"
#include "solver/mesh/glb_writer.h"
#include "solver/registry/alternatives.h"
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

std::optional<Example> find_built_in(const std::string& id) { return examples::find(id); }

// Jobs are on servers.
proto::Parsed<proto::JobRequest> find_no_job(
    const std::string& /*id*/, std::uint32_t /*alternative*/
) {
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

    void on_warnings(std::span<const std::string> warnings) override { display_.warn(warnings); }

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

// Makes the models that a request asks for and writes each when it is there.
class LocalRun {
  public:
    LocalRun(const RunOptions& options, const proto::JobRequest& request, ProgressDisplay& display)
        : options_(options),
          request_(request),
          display_(display),
          watchdog_(request.deadline_seconds) {}

    Outcome<std::vector<RunReport::File>> run() {
        Alternatives series(request_.task.seed, request_.alternatives.value_or(1));
        std::vector<RunReport::File> files;
        while (!series.is_complete()) {
            auto made = make(series.next_seed());
            if (is_interrupted()) {
                return tl::unexpected(Failure{ExitCode::kInterrupted, "interrupted"});
            }
            if (!made) {
                const ErrorCode code = made.error().code;
                const bool goes_on = series.add_failure(code) && request_.alternatives;
                if (!goes_on && (files.empty() || code != ErrorCode::kGaveUp)) {
                    return tl::unexpected(failure_of(problem_of(made.error())));
                }
                continue;
            }
            if (series.add(std::move(made->identity))) {
                continue;  // as an earlier one
            }
            auto file = write(made->glb, static_cast<std::uint32_t>(files.size()));
            if (!file) {
                return tl::unexpected(std::move(file.error()));
            }
            files.push_back(std::move(*file));
        }
        return files;
    }

  private:
    struct Made {
        std::string glb;
        std::string identity;  // by which models are equal: the file in the default form
    };

    Result<Made> make(std::uint64_t seed) {
        ShowProgress observer(display_);
        Task task = request_.task;
        task.seed = seed;
        return modelsynth::run(
                   task,
                   preparations_,
                   observer,
                   watchdog_.token(),
                   nullptr,
                   std::max(1U, std::thread::hardware_concurrency())
        )
            .and_then([this](const Finished& finished) { return draw(finished.model); });
    }

    [[nodiscard]] Result<Made> draw(const Model& model) const {
        const Scene scene = whole_scene(model);
        GlbOptions wanted;
        wanted.profile = profile_of(options_.form.profile);
        wanted.compression = options_.form.compression == "meshopt" ? GlbCompression::kMeshopt
                                                                    : GlbCompression::kNone;
        return write_glb(scene, wanted).and_then([&](std::string glb) -> Result<Made> {
            const bool is_default =
                wanted.profile == GlbProfile::kNodes && wanted.compression == GlbCompression::kNone;
            if (!request_.alternatives || is_default) {
                std::string identity = request_.alternatives ? glb : "";
                return Made{std::move(glb), std::move(identity)};
            }
            return write_glb(scene).map([&glb](std::string identity) {
                return Made{std::move(glb), std::move(identity)};
            });
        });
    }

    [[nodiscard]] proto::Problem problem_of(const Error& error) const {
        const bool is_late = error.code == ErrorCode::kCancelled && watchdog_.is_past_deadline();
        return is_late
                   ? proto::make_problem("deadline-exceeded", "the deadline passed while solving")
                   : proto::problem_of(error);
    }

    Outcome<RunReport::File> write(const std::string& glb, std::uint32_t number) {
        display_.finish();
        const std::string name = numbered_file(options_.output, number);
        OutputFile file(name);
        static_cast<void>(file.write(glb));  // commit() tells whether it went well
        if (is_interrupted()) {
            return tl::unexpected(Failure{ExitCode::kInterrupted, "interrupted"});
        }
        return file.commit().map([&] { return RunReport::File{name, file.bytes_written()}; });
    }

    const RunOptions& options_;
    const proto::JobRequest& request_;
    ProgressDisplay& display_;
    Watchdog watchdog_;
    Preparations preparations_;
};

}  // namespace

void complete_request(RequestOptions& request) {
    if (request.solver.empty() && request.from.empty() && request.request_file.empty()) {
        if (const auto example = examples::find(request.example)) {
            request.solver = solver_of(*example);
        }
    }
}

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
    if (options.output == "-" && request->alternatives.value_or(1) > 1) {
        return wrong_usage("several models do not go to standard output");
    }
    ProgressDisplay display(choose_style(as_json));
    return LocalRun(options, *request, display).run().map([&](std::vector<RunReport::File> files) {
        print_report(
            {"", std::move(files), request->task.seed, display.progress(), display.elapsed()},
            as_json
        );
    });
}

}  // namespace modelsynth::cli
