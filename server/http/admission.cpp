#include "server/http/admission.h"

#include "proto/timestamp.h"
#include "server/http/request_fields.h"

#include <chrono>
#include <utility>

namespace modelsynth::server {

using proto::make_problem;

namespace {

constexpr const char* kExposed =
    "ETag, Location, Retry-After, RateLimit, RateLimit-Policy, Idempotent-Replayed, "
    "Preference-Applied, X-Request-Id, Accept-Ranges, Content-Range, Content-Disposition";
constexpr const char* kTaken =
    "Authorization, Content-Type, Accept, Idempotency-Key, Prefer, If-Match, If-None-Match, "
    "If-Range, Range, Last-Event-ID, Cache-Control, X-Request-Id, traceparent";

std::optional<std::string> bearer_key(const Request& request) {
    const std::string field = request.header("authorization").value_or("");
    constexpr std::size_t kScheme = 7;
    if (lower_case(field.substr(0, kScheme)) != "bearer ") {
        return std::nullopt;
    }
    const std::size_t begin = field.find_first_not_of(' ', kScheme);
    return begin == std::string::npos ? std::nullopt : std::optional(field.substr(begin));
}

Response unauthorized(const Request& request) {
    const bool has_key = request.header("authorization").has_value();
    Response response = problem_response(
        make_problem(
            "unauthorized",
            has_key ? "the key is not known here" : "send the key as Authorization: Bearer KEY"
        ),
        request
    );
    response.headers.emplace_back(
        "WWW-Authenticate",
        std::string("Bearer realm=\"modelsynth\"") + (has_key ? ", error=\"invalid_token\"" : "")
    );
    return response;
}

const char* scope_name(proto::Scope scope) {
    switch (scope) {
        case proto::Scope::kRead:
            return "read";
        case proto::Scope::kSubmit:
            return "submit";
        case proto::Scope::kAdmin:
            break;
    }
    return "admin";
}

}  // namespace

tl::expected<void, std::string> Admission::load_keys() {
    if (config_.keys_file.empty()) {
        return {};
    }
    auto ring = KeyRing::load(config_.keys_file);
    if (!ring) {
        return tl::unexpected(std::move(ring.error()));
    }
    auto shared = std::make_shared<const KeyRing>(std::move(*ring));
    const std::lock_guard lock(mutex_);
    keys_ = std::move(shared);
    return {};
}

std::shared_ptr<const KeyRing> Admission::keys() const {
    const std::lock_guard lock(mutex_);
    return keys_;
}

std::optional<Response> Admission::check_browser(Request& request) const {
    const std::string host = request.header("host").value_or("");
    // Where a key is needed the browser has none to send on its own.
    if (!keys() && !is_host_allowed(host, config_.browsers)) {
        return problem_response(
            make_problem(
                "unknown-host",
                host.substr(0, 64) + " is no name of this server; --allow-host makes it one"
            ),
            request
        );
    }
    request.answer_fields.emplace_back("Vary", "Origin");
    const auto origin = request.header("origin");
    if (!origin || !is_origin_allowed(*origin, host, config_.browsers)) {
        return std::nullopt;
    }
    request.answer_fields.emplace_back("Access-Control-Allow-Origin", *origin);
    request.answer_fields.emplace_back("Access-Control-Expose-Headers", kExposed);
    if (request.method == "OPTIONS" && request.header("access-control-request-method")) {
        Response response = {204, {}, std::string()};
        response.headers = {
            {"Access-Control-Allow-Methods", "GET, HEAD, POST, DELETE"},
            {"Access-Control-Allow-Headers", kTaken},
            {"Access-Control-Max-Age", "600"}};
        return response;
    }
    return std::nullopt;
}

std::optional<proto::KeyEntry> Admission::key_of(Request& request, const Need& need) {
    const auto ring = keys();
    if (const auto secret = bearer_key(request)) {
        const proto::KeyEntry* key = ring->find(*secret);
        return key == nullptr ? std::nullopt : std::optional(*key);
    }
    const auto text = request.query_field("ticket");
    if (!text || !need.takes_tickets) {
        return std::nullopt;
    }
    auto ticket = tickets_.take(*text, Tickets::Clock::now());
    const bool is_for_this =
        ticket &&
        (ticket->job_id.empty() || (request.path.size() > 2 && request.path[2] == ticket->job_id));
    return is_for_this ? std::optional(std::move(ticket->key)) : std::nullopt;
}

std::optional<Response> Admission::admit(Request& request, const Need& need) {
    const auto origin = request.header("origin");
    if (need.changes_things && origin &&
        !is_origin_allowed(*origin, request.header("host").value_or(""), config_.browsers)) {
        return problem_response(
            make_problem(
                "forbidden-origin",
                "pages of " + origin->substr(0, 128) +
                    " are not allowed; --allow-origin allows them"
            ),
            request
        );
    }
    std::optional<proto::KeyEntry> key;
    if (keys() && need.scope) {
        key = key_of(request, need);
        if (!key) {
            return unauthorized(request);
        }
        request.caller.owner = key->name;
        request.caller.sees_all = may(*key, proto::Scope::kAdmin);
        request.caller.unfinished_max = key->jobs.value_or(request.caller.unfinished_max);
    }
    if (need.takes_tickets) {
        std::erase_if(request.query, [](const auto& field) { return field.first == "ticket"; });
    }
    if (!key) {
        return std::nullopt;
    }
    if (key->rate) {
        const auto verdict = rates_.take(key->name, *key->rate, RateLimiter::Clock::now());
        request.answer_fields.emplace_back(
            "RateLimit-Policy",
            "\"burst\";q=" + std::to_string(verdict.quota) +
                ";w=" + std::to_string(verdict.window_seconds)
        );
        request.answer_fields.emplace_back(
            "RateLimit",
            "\"burst\";r=" + std::to_string(verdict.remaining) +
                ";t=" + std::to_string(verdict.reset_seconds)
        );
        if (!verdict.is_granted) {
            auto problem = make_problem(
                "too-fast", "the key has a burst of " + std::to_string(verdict.quota) + " requests"
            );
            problem.retry_after_seconds = verdict.reset_seconds;
            return problem_response(problem, request);
        }
    }
    if (!may(*key, *need.scope)) {
        return problem_response(
            make_problem(
                "missing-scope",
                std::string("the key does not have the scope ") + scope_name(*need.scope)
            ),
            request
        );
    }
    request.key = std::make_shared<const proto::KeyEntry>(std::move(*key));
    return std::nullopt;
}

Response Admission::give_ticket(const Request& request, const std::string& job_id) {
    const proto::KeyEntry key = request.key ? *request.key : proto::KeyEntry{};
    const auto text = tickets_.give({key, job_id}, Tickets::Clock::now());
    if (!text) {
        return problem_response(
            make_problem("unavailable", "too many tickets wait to be used"), request
        );
    }
    const proto::UnixMillis until =
        proto::now_millis() + std::chrono::milliseconds(Tickets::kLifetime).count();
    Response response = json_response(
        201, R"({"ticket":")" + *text + R"(","expires":")" + proto::to_rfc3339(until) + "\"}"
    );
    response.headers.emplace_back("Cache-Control", "no-store");
    return response;
}

}  // namespace modelsynth::server
