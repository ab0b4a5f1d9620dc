#pragma once

#include "server/http/http_observer.h"
#include "server/jobs/job_observer.h"
#include "server/webhooks/webhook_observer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace modelsynth::server {

// What is counted, for GET /metrics. Thread-safe; nothing blocks but text().
class Metrics final : public HttpObserver, public JobObserver, public WebhookObserver {
  public:
    // What is not counted but looked at whenever metrics are asked for.
    struct Levels {
        std::uint64_t jobs_queued = 0;
        std::uint64_t jobs_running = 0;
        std::uint64_t webhooks_waiting = 0;
        std::uint64_t artifact_bytes = 0;
        std::uint64_t disk_free_bytes = 0;
        std::uint64_t log_lines_dropped = 0;  // ever
    };

    explicit Metrics(const std::string& version);
    ~Metrics() override;

    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    // Everything in Prometheus' text format.
    [[nodiscard]] std::string text(const Levels& levels);

    void on_commit(double seconds);

    void on_answer(const Answer& answer) override;
    void on_connections(int change) override;
    void on_websockets(int change) override;
    void on_connection_refused(std::string_view reason) override;
    void on_events_dropped(std::string_view reason, std::uint64_t count) override;

    void on_started(double waited_seconds) override;
    void on_block(std::string_view example, bool accepted) override;
    void on_ended(std::string_view solver, std::string_view result, double seconds) override;

    void on_try(std::string_view outcome, double seconds) override;

  private:
    struct Families;
    std::unique_ptr<Families> families_;
};

}  // namespace modelsynth::server
