#include "server/http/access_log.h"

#include "server/http/connection.h"
#include "server/log/event_line.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace modelsynth::server {

namespace {

// Longer than any id; what a client puts there instead is its own affair.
constexpr std::size_t kIdCharactersMax = 64;

std::string_view known_method(const std::string& method) {
    static constexpr std::array<std::string_view, 5> kKnown = {
        "GET", "HEAD", "POST", "DELETE", "OPTIONS"};
    const auto found = std::find(kKnown.begin(), kKnown.end(), method);
    return found == kKnown.end() ? "other" : *found;
}

std::string job_of(const Request& request, const AnswerRecord& answer) {
    return request.route.starts_with("/v1/jobs/{id}")
               ? request.resource_id.substr(0, kIdCharactersMax)
               : answer.job_id;
}

}  // namespace

void report_answer(
    const Request& request, const AnswerRecord& answer, const ConnectionContext& context
) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - answer.begun;
    const std::string_view method = known_method(request.method);
    context.observer->on_answer(
        {request.route,
         method,
         answer.status,
         answer.bytes,
         took.count(),
         answer.is_stream,
         answer.problem}
    );
    const bool merely_looks =
        request.route == "/healthz" || request.route == "/readyz" || request.route == "/metrics";
    log_event(
        *context.log,
        merely_looks ? spdlog::level::debug : spdlog::level::info,
        "request",
        {{"method", method},
         {"route", request.route},
         {"status", answer.status},
         {"problem", answer.problem},
         {"bytes", answer.bytes},
         {"seconds", took.count()},
         {"request", request.id},
         {"job", job_of(request, answer)},
         {"key", request.key ? request.key->name : ""},
         {"traceparent", request.traceparent}}
    );
}

}  // namespace modelsynth::server
