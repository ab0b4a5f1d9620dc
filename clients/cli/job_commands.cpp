#include "clients/cli/job_commands.h"

#include "clients/cli/event_follower.h"
#include "clients/cli/output_file.h"
#include "clients/cli/progress.h"
#include "clients/cli/run_report.h"
#include "clients/cli/server_url.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <utility>

namespace modelsynth::cli {

namespace {

struct Submitted {
    std::string id;
    std::uint64_t seed = 0;
    std::string job;  // as the server answered it
};

Outcome<Submitted> post_job(
    const HttpClient& client, const RequestOptions& options, const std::string& idempotency_key
) {
    auto body = make_request_body(options);
    if (!body) {
        return tl::unexpected(std::move(body.error()));
    }
    HttpRequest request{"POST", "/v1/jobs", "application/json", std::move(*body)};
    if (!idempotency_key.empty()) {
        request.headers = {{"Idempotency-Key", idempotency_key}};
    }
    return client.send(request).and_then([](const HttpAnswer& answer) -> Outcome<Submitted> {
        const auto job = nlohmann::ordered_json::parse(answer.body, nullptr, false);
        if (!job.is_object() || !job.contains("id") || !job["id"].is_string()) {
            return tl::unexpected(Failure{ExitCode::kFailed, "the server answered with no job"});
        }
        return Submitted{job["id"], job.value("seed", std::uint64_t{0}), job.dump()};
    });
}

Outcome<void> outcome_of(const JobEnd& end, const std::string& job_id) {
    if (end.state == "succeeded") {
        return {};
    }
    Failure failure = failure_of_problem(end.error);
    if (failure.message.empty()) {
        failure.message =
            "the job " + job_id + (end.state == "failed" ? " failed" : " was cancelled");
    }
    return tl::unexpected(std::move(failure));
}

// Shows a job until it ends; how many models it made. `prints_events`: each as a line of JSON on
// standard output.
Outcome<std::uint32_t> watch(
    const HttpClient& client,
    const FollowOptions& options,
    bool prints_events,
    ProgressDisplay& display
) {
    auto end = follow_job(client, options.job_id, options.after, [&](const JobEvent& event) {
        if (prints_events) {
            print_line(event.text);
        }
        display.take(event);
    });
    display.finish();
    if (!end && end.error().code == ExitCode::kInterrupted) {
        end.error().message = "interrupted; the job " + options.job_id + " goes on";
    }
    return end.and_then([&options](const JobEnd& ended) {
        return outcome_of(ended, options.job_id).map([&ended] { return ended.models; });
    });
}

std::string artifact_target(const FetchOptions& options) {
    const std::string job = "/v1/jobs/" + percent_encode(options.job_id);
    std::string query;
    const auto add = [&query](const char* name, const std::string& value) {
        query += (query.empty() ? "?" : "&") + (name + ("=" + percent_encode(value)));
    };
    if (options.alternative) {
        add("alternative", std::to_string(*options.alternative));
    }
    if (options.is_labels) {
        return job + "/labels.json" + query;
    }
    if (!options.form.profile.empty()) {
        add("profile", options.form.profile);
    }
    if (!options.form.compression.empty()) {
        add("compression", options.form.compression);
    }
    return job + (options.is_preview ? "/preview.glb" : "/model.glb") + query;
}

// The bytes written.
Outcome<std::uint64_t> download(const HttpClient& client, const FetchOptions& options) {
    OutputFile file(options.output);
    const auto answer =
        client.send({.target = artifact_target(options)}, [&file](std::string_view bytes) {
            return file.write(bytes);
        });
    if (!answer && file.is_good()) {
        return tl::unexpected(answer.error());
    }
    return file.commit().map([&file] { return file.bytes_written(); });
}

std::string fetched_json(const FetchOptions& options, std::uint64_t bytes) {
    return nlohmann::ordered_json{
        {"job", options.job_id}, {"file", options.output}, {"bytes", bytes}}
        .dump();
}

// What comes after the submission: following and, where there is an output, fetching.
Outcome<RunReport> finish_job(
    const HttpClient& client,
    const Submitted& job,
    const FetchOptions& wanted,
    bool prints_events,
    bool as_json
) {
    ProgressDisplay display(choose_style(as_json));
    auto watched = watch(client, {job.id}, prints_events, display);
    if (!watched) {
        return tl::unexpected(std::move(watched.error()));
    }
    RunReport report{job.id, {}, job.seed, display.progress(), {}};
    const std::uint32_t files = wanted.output.empty() ? 0 : wanted.output == "-" ? 1 : *watched;
    for (std::uint32_t i = 0; i < files; ++i) {
        FetchOptions one = wanted;
        one.output = numbered_file(wanted.output, i);
        if (i > 0) {
            one.alternative = i;
        }
        auto bytes = download(client, one);
        if (!bytes) {
            return tl::unexpected(std::move(bytes.error()));
        }
        report.files.push_back({one.output, *bytes});
    }
    report.elapsed = display.elapsed();
    return report;
}

// A line on standard error.
void note(const std::string& line) { std::fprintf(stderr, "%s\n", printable(line).c_str()); }

void note_success(const std::string& job_id, const Progress& progress) {
    note("the job " + job_id + " succeeded: " + describe_blocks(progress));
}

}  // namespace

Outcome<void> submit(const HttpClient& client, const SubmitOptions& options, bool as_json) {
    const bool is_fetched = !options.output.empty();
    if (is_fetched) {
        if (auto usable = OutputFile::check(options.output); !usable) {
            return usable;
        }
    }
    auto job = post_job(client, options.request, options.idempotency_key);
    if (!job) {
        return tl::unexpected(std::move(job.error()));
    }
    if (options.output == "-") {
        note(job->id);
    } else {
        print_line(as_json ? job->job : job->id);
    }
    if (!is_fetched && !options.is_followed) {
        return {};
    }
    const FetchOptions wanted{job->id, options.output, options.form};
    return finish_job(client, *job, wanted, as_json, as_json).map([&](const RunReport& report) {
        if (is_fetched) {
            print_report(report, as_json);
        } else if (!as_json) {
            note_success(report.job_id, report.progress);
        }
    });
}

Outcome<void> follow(const HttpClient& client, const FollowOptions& options, bool as_json) {
    ProgressDisplay display(choose_style(as_json));
    return watch(client, options, as_json, display).map([&](std::uint32_t /*models*/) {
        if (!as_json) {
            note_success(options.job_id, display.progress());
        }
    });
}

Outcome<void> fetch(const HttpClient& client, const FetchOptions& options, bool as_json) {
    if (auto usable = OutputFile::check(options.output); !usable) {
        return usable;
    }
    return download(client, options).map([&](std::uint64_t bytes) {
        if (as_json) {
            print_line(fetched_json(options, bytes));
        } else if (options.output != "-") {
            note(options.output + ": " + std::to_string(bytes) + " bytes");
        }
    });
}

Outcome<void> run_on_server(const HttpClient& client, const RunOptions& options, bool as_json) {
    if (auto usable = OutputFile::check(options.output); !usable) {
        return usable;
    }
    auto job = post_job(client, options.request, "");
    if (!job) {
        return tl::unexpected(std::move(job.error()));
    }
    if (!as_json) {
        note("job " + job->id);  // for going on by hand, should this be interrupted
    }
    const FetchOptions wanted{job->id, options.output, options.form};
    return finish_job(client, *job, wanted, false, as_json).map([&](const RunReport& report) {
        print_report(report, as_json);
    });
}

}  // namespace modelsynth::cli
