#pragma once

#include "server/http/admission.h"
#include "server/http/documents.h"
#include "server/http/message.h"
#include "server/jobs/job_service.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace modelsynth::server {

struct HttpLimits {
    std::size_t target_bytes_max = 8 * 1024;
    std::size_t head_bytes_max = 16 * 1024;
    std::size_t fields_max = 100;
    std::uint64_t job_body_bytes_max = std::uint64_t{8} << 20;
    std::uint64_t upload_body_bytes_max = std::uint64_t{64} << 20;
    std::uint64_t other_body_bytes_max = 64 * 1024;
    std::uint32_t idle_seconds = 60;
    std::uint32_t head_seconds = 10;
    std::uint32_t body_seconds = 30;
    std::uint32_t write_seconds = 30;
    std::uint32_t requests_per_connection_max = 10'000;
    std::size_t connections_max = 4096;
    std::size_t connections_per_address_max = 0;  // 0: no limit
    // Streams: a WebSocket is pinged after half of this silence and closed after the whole, a
    // comment is sent on an event stream after a quarter.
    std::uint32_t stream_idle_seconds = 60;
    int stream_send_buffer_bytes = 256 * 1024;  // of the kernel, which keeps twice as much
    std::size_t stream_subscriptions_max = 64;  // jobs that one WebSocket follows at once
    std::size_t stream_pending_max = 32;        // requests on one WebSocket that wait for answers
};

// The resources of the contract as functions from requests to answers. Knows no socket; calls
// block. Thread-safe.
class Api {
  public:
    // `metrics`: what GET /metrics answers with.
    Api(JobService& service,
        Admission& admission,
        const HttpLimits& limits,
        Documents documents,
        std::function<std::string()> metrics)
        : service_(service),
          admission_(admission),
          limits_(limits),
          documents_(std::move(documents)),
          metrics_(std::move(metrics)) {}

    // What can be refused before the body is read: unknown paths, wrong methods, callers who may
    // not ask, bodies that are too long or of another type. Nothing when the body is wanted; then
    // the request tells on whose behalf it is.
    [[nodiscard]] std::optional<Response> check_head(Request& request);

    // How long the body may be.
    [[nodiscard]] std::uint64_t body_bytes_max(const Request& request) const;

    [[nodiscard]] Response handle(const Request& request);

    // The job as the answer of a request that waited for it.
    [[nodiscard]] Response answer_with_job(
        const Request& request, const Response& held, const WaitForJob& wait
    );

    [[nodiscard]] JobService& service() { return service_; }

  private:
    JobService& service_;
    Admission& admission_;
    HttpLimits limits_;
    Documents documents_;
    std::function<std::string()> metrics_;
};

}  // namespace modelsynth::server
