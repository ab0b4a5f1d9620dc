// The names are those that operators and dashboards know; they change no more than the contract
// does. Labels are of bounded sets: route templates, never ids or keys.

#include "server/ops/metrics.h"

#include "proto/problem.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <mutex>

namespace modelsynth::server {

namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;
using prometheus::Registry;

// Upper ends, in seconds: of what is answered while somebody waits,
const Histogram::BucketBoundaries kRequestSeconds = {
    0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60};
// of jobs, up to an hour,
const Histogram::BucketBoundaries kJobSeconds = {
    0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60, 150, 300, 600, 1800, 3600};
// of tries of webhooks, up to the most that a receiver may be given to answer,
const Histogram::BucketBoundaries kTrySeconds = {
    0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60, 300};
// and of commits.
const Histogram::BucketBoundaries kCommitSeconds = {
    0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 5};

Family<Counter>& counters(Registry& registry, const char* name, const char* help) {
    return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Gauge>& gauges(Registry& registry, const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry);
}

Family<Histogram>& histograms(Registry& registry, const char* name, const char* help) {
    return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

// Answers that turn somebody away, for whom the client can do nothing but come back or be let in.
bool is_rejection(int status) {
    return status == 401 || status == 403 || status == 413 || status == 429 || status == 503;
}

}  // namespace

struct Metrics::Families {
    std::mutex levels_mutex;
    Registry registry;

    Family<Counter>& jobs =
        counters(registry, "modelsynth_jobs_total", "Jobs that ended, by how they did.");
    Gauge& jobs_queued =
        gauges(registry, "modelsynth_jobs_queued", "Jobs that wait for a worker.").Add({});
    Gauge& jobs_running =
        gauges(registry, "modelsynth_jobs_running", "Jobs that workers have in hand.").Add({});
    Histogram& queue_wait = histograms(
                                registry,
                                "modelsynth_queue_wait_seconds",
                                "From the submission of a job until a worker first took it."
    )
                                .Add({}, kJobSeconds);
    Family<Histogram>& job_seconds =
        histograms(registry, "modelsynth_job_seconds", "How long jobs that ended were worked on.");
    Family<Counter>& blocks = counters(
        registry, "modelsynth_blocks_total", "Blocks that were solved, by what became of them."
    );
    Family<Counter>& requests =
        counters(registry, "modelsynth_http_requests_total", "Requests that were answered.");
    Family<Histogram>& request_seconds = histograms(
        registry,
        "modelsynth_http_request_seconds",
        "From the first byte of a request to the last of its answer; without streams."
    );
    Counter& response_bytes = counters(
                                  registry,
                                  "modelsynth_http_response_bytes_total",
                                  "Bytes of answers, heads included; without WebSockets."
    )
                                  .Add({});
    Gauge& connections = gauges(registry, "modelsynth_connections", "Open connections.").Add({});
    Gauge& websockets = gauges(registry, "modelsynth_ws_connections", "Open WebSockets.").Add({});
    Family<Counter>& events_dropped = counters(
        registry,
        "modelsynth_events_dropped_total",
        "Events and frames that listeners were given a snapshot or a whole state in place of."
    );
    Family<Counter>& rejected = counters(
        registry, "modelsynth_rejected_total", "Requests and connections that were turned away."
    );
    Histogram& commit_seconds =
        histograms(
            registry, "modelsynth_store_commit_seconds", "How long commits of the store took."
        )
            .Add({}, kCommitSeconds);
    Family<Counter>& webhook_tries = counters(
        registry,
        "modelsynth_webhook_tries_total",
        "Tries to deliver webhooks that ended, by what became of the webhook."
    );
    Histogram& webhook_try_seconds = histograms(
                                         registry,
                                         "modelsynth_webhook_try_seconds",
                                         "How long receivers of webhooks took, or were given."
    )
                                         .Add({}, kTrySeconds);
    Gauge& webhooks_waiting =
        gauges(registry, "modelsynth_webhooks_waiting", "Webhooks that are not delivered yet.")
            .Add({});
    Gauge& artifact_bytes =
        gauges(registry, "modelsynth_artifact_bytes", "Bytes of the artifacts that are kept.")
            .Add({});
    Gauge& disk_free_bytes =
        gauges(registry, "modelsynth_disk_free_bytes", "Bytes left where artifacts are kept.")
            .Add({});
    Counter& log_lines_dropped =
        counters(
            registry, "modelsynth_log_lines_dropped_total", "Lines of the log that had no room."
        )
            .Add({});
    Family<Gauge>& build_info =
        gauges(registry, "modelsynth_build_info", "Always 1; tells the version.");
};

Metrics::Metrics(const std::string& version) : families_(std::make_unique<Families>()) {
    families_->build_info.Add({{"version", version}}).Set(1);
    // From nothing, or a rate would miss the first of each.
    for (const char* outcome : {"delivered", "retried", "given-up"}) {
        families_->webhook_tries.Add({{"outcome", outcome}});
    }
    for (const proto::ProblemKind& kind : proto::problem_kinds()) {
        if (is_rejection(kind.status)) {
            families_->rejected.Add({{"reason", kind.name}});
        }
    }
    for (const char* reason : {"connections", "connections-of-address"}) {
        families_->rejected.Add({{"reason", reason}});
    }
    for (const char* reason : {"slow-reader", "frame-not-kept"}) {
        families_->events_dropped.Add({{"reason", reason}});
    }
}

Metrics::~Metrics() = default;

std::string Metrics::text(const Levels& levels) {
    Families& families = *families_;
    const std::lock_guard lock(families.levels_mutex);
    families.jobs_queued.Set(static_cast<double>(levels.jobs_queued));
    families.jobs_running.Set(static_cast<double>(levels.jobs_running));
    families.webhooks_waiting.Set(static_cast<double>(levels.webhooks_waiting));
    families.artifact_bytes.Set(static_cast<double>(levels.artifact_bytes));
    families.disk_free_bytes.Set(static_cast<double>(levels.disk_free_bytes));
    families.log_lines_dropped.Increment(
        static_cast<double>(levels.log_lines_dropped) - families.log_lines_dropped.Value()
    );
    return prometheus::TextSerializer().Serialize(families.registry.Collect());
}

void Metrics::on_commit(double seconds) { families_->commit_seconds.Observe(seconds); }

void Metrics::on_answer(const Answer& answer) {
    const std::string route(answer.route);
    families_->requests
        .Add(
            {{"route", route},
             {"method", std::string(answer.method)},
             {"code", std::to_string(answer.status)}}
        )
        .Increment();
    families_->response_bytes.Increment(static_cast<double>(answer.bytes));
    if (!answer.is_stream) {
        families_->request_seconds.Add({{"route", route}}, kRequestSeconds).Observe(answer.seconds);
    }
    if (is_rejection(answer.status) && !answer.problem.empty()) {
        families_->rejected.Add({{"reason", std::string(answer.problem)}}).Increment();
    }
}

void Metrics::on_connections(int change) { families_->connections.Increment(change); }

void Metrics::on_websockets(int change) { families_->websockets.Increment(change); }

void Metrics::on_connection_refused(std::string_view reason) {
    families_->rejected.Add({{"reason", std::string(reason)}}).Increment();
}

void Metrics::on_events_dropped(std::string_view reason, std::uint64_t count) {
    families_->events_dropped.Add({{"reason", std::string(reason)}}
    ).Increment(static_cast<double>(count));
}

void Metrics::on_started(double waited_seconds) { families_->queue_wait.Observe(waited_seconds); }

void Metrics::on_block(std::string_view example, bool accepted) {
    families_->blocks
        .Add({{"example", std::string(example)}, {"outcome", accepted ? "accepted" : "reverted"}})
        .Increment();
}

void Metrics::on_ended(std::string_view solver, std::string_view result, double seconds) {
    const std::string name(solver);
    families_->jobs.Add({{"solver", name}, {"result", std::string(result)}}).Increment();
    if (seconds > 0) {
        families_->job_seconds.Add({{"solver", name}}, kJobSeconds).Observe(seconds);
    }
}

void Metrics::on_try(std::string_view outcome, double seconds) {
    families_->webhook_tries.Add({{"outcome", std::string(outcome)}}).Increment();
    families_->webhook_try_seconds.Observe(seconds);
}

}  // namespace modelsynth::server
