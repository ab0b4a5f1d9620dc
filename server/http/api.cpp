#include "server/http/api.h"

#include "proto/job.h"
#include "server/http/content_coding.h"
#include "server/http/handlers.h"
#include "server/http/query_reader.h"
#include "server/http/representation.h"
#include "server/http/request_fields.h"

#include <algorithm>
#include <array>
#include <utility>

namespace modelsynth::server {

using proto::make_problem;

namespace {

using Handler = Response (*)(const Call&);

// What the body of a request may be.
enum class BodyKind : std::uint8_t { kOther, kJob, kUpload };

struct Route {
    const char* method;
    const char* path;  // segments, {id} stands for an id
    Handler handler;
    BodyKind body = BodyKind::kOther;
};

// Health, and what there is to read before one has a key.
constexpr std::array<const char*, 7> kOpen = {
    "/healthz", "/readyz", "/problems/{id}", "/openapi.json", "/asyncapi.json", "/docs", "/"};

// What a browser opens without being able to send a key.
constexpr std::array<const char*, 3> kStreams = {
    "/v1/jobs/{id}/events", "/v1/jobs/{id}/stream", "/v1/stream"};

template <std::size_t N>
bool is_among(const std::array<const char*, N>& paths, std::string_view path) {
    return std::find(paths.begin(), paths.end(), path) != paths.end();
}

Need need_of(const Route& route) {
    const bool is_get = std::string_view(route.method) == "GET";
    Need need;
    need.takes_tickets = is_among(kStreams, route.path);
    // A WebSocket is none of what browsers keep from other pages.
    need.changes_things = !is_get || need.takes_tickets;
    if (!is_among(kOpen, route.path)) {
        const bool only_reads = is_get || std::string_view(route.path) == "/v1/tickets";
        need.scope = only_reads ? proto::Scope::kRead : proto::Scope::kSubmit;
        if (std::string_view(route.path) == "/metrics") {
            need.scope = proto::Scope::kAdmin;  // it tells of everybody's jobs
        }
    }
    return need;
}

// What takes parameters reads them itself; pages and probes leave them to those who add some.
constexpr std::array<const char*, 7> kWithQuery = {
    "/v1/jobs",
    "/v1/jobs/{id}",
    "/v1/jobs/{id}/model.glb",
    "/v1/jobs/{id}/labels.json",
    "/v1/jobs/{id}/events",
    "/v1/jobs/{id}/stream",
    "/v1/examples/{id}/figures.svg"};

bool takes_no_query(const Route& route) {
    const std::string_view path = route.path;
    return path.starts_with("/v1/") &&
           (std::string_view(route.method) != "GET" || !is_among(kWithQuery, path));
}

constexpr std::array<Route, 32> kRoutes = {
    {{"POST", "/v1/jobs", submit_job, BodyKind::kJob},
     {"GET", "/v1/jobs", list_jobs},
     {"GET", "/v1/jobs/{id}", get_job},
     {"DELETE", "/v1/jobs/{id}", delete_job},
     {"POST", "/v1/jobs/{id}/cancel", cancel_job},
     {"GET", "/v1/jobs/{id}/model.glb", get_model},
     {"GET", "/v1/jobs/{id}/preview.glb", get_preview},
     {"GET", "/v1/jobs/{id}/labels.json", get_labels},
     {"GET", "/v1/jobs/{id}/events", get_events},
     {"GET", "/v1/jobs/{id}/stream", get_stream},
     {"GET", "/v1/stream", get_shared_stream},
     {"GET", "/v1/examples", list_examples},
     {"POST", "/v1/examples", upload_example, BodyKind::kUpload},
     {"GET", "/v1/examples/{id}", get_example},
     {"DELETE", "/v1/examples/{id}", delete_example},
     {"GET", "/v1/examples/{id}/model.glb", get_example_model},
     {"GET", "/v1/examples/{id}/pieces.glb", get_example_pieces},
     {"GET", "/v1/examples/{id}/analysis", get_example_analysis},
     {"GET", "/v1/examples/{id}/success.svg", get_example_success},
     {"GET", "/v1/examples/{id}/figures.svg", get_example_figures},
     {"GET", "/v1/solvers", list_solvers},
     {"GET", "/v1/solvers/{id}", get_solver},
     {"POST", "/v1/tickets", give_ticket},
     {"GET", "/healthz", healthz},
     {"GET", "/readyz", readyz},
     {"GET", "/metrics", get_metrics},
     {"GET", "/problems/{id}", get_problem},
     {"GET", "/v1/limits", get_limits},
     {"GET", "/openapi.json", get_openapi},
     {"GET", "/asyncapi.json", get_asyncapi},
     {"GET", "/docs", get_docs_page},
     {"GET", "/", get_start_page}}};

// Whether the path is the route's; the id that it carries goes to `id`.
bool matches(const char* route, const std::vector<std::string>& path, std::string& id) {
    std::string_view rest = route;
    if (rest == "/") {
        return path.empty();
    }
    std::string found;
    for (const std::string& segment : path) {
        if (rest.empty()) {
            return false;
        }
        rest.remove_prefix(1);
        const std::string_view wanted = rest.substr(0, rest.find('/'));
        if (wanted == "{id}" && !segment.empty()) {
            found = segment;
        } else if (wanted != segment) {
            return false;
        }
        rest.remove_prefix(wanted.size());
    }
    if (!rest.empty()) {
        return false;
    }
    id = std::move(found);
    return true;
}

struct Match {
    const Route* route = nullptr;  // none: the path has no such method
    std::string id;
    std::string allow;  // methods of the path; empty: there is no such path
};

Match find_route(const Request& request) {
    const std::string method = request.method == "HEAD" ? "GET" : request.method;
    Match match;
    for (const Route& route : kRoutes) {
        if (!matches(route.path, request.path, match.id)) {
            continue;
        }
        const std::string allowed = route.method;
        match.allow += (match.allow.empty() ? "" : ", ") + allowed;
        match.allow += allowed == "GET" ? ", HEAD" : "";
        if (allowed == method) {
            match.route = &route;
        }
    }
    return match;
}

// A body without a type is taken for JSON.
bool is_taken(const Request& request, BodyKind body) {
    const auto type = media_type(request);
    return !type || *type == "application/json" ||
           (body == BodyKind::kUpload && *type == "model/gltf-binary");
}

}  // namespace

std::uint64_t Api::body_bytes_max(const Request& request) const {
    const Match match = find_route(request);
    switch (match.route == nullptr ? BodyKind::kOther : match.route->body) {
        case BodyKind::kJob:
            return limits_.job_body_bytes_max;
        case BodyKind::kUpload:
            return limits_.upload_body_bytes_max;
        case BodyKind::kOther:
            break;
    }
    return limits_.other_body_bytes_max;
}

std::optional<Response> Api::check_head(Request& request) {
    if (auto answer = admission_.check_browser(request)) {
        return answer;
    }
    const Match match = find_route(request);
    if (match.allow.empty()) {
        return problem_response(
            make_problem("not-found", "there is nothing at this path"), request
        );
    }
    if (match.route == nullptr) {
        Response response = problem_response(
            make_problem("method-not-allowed", request.method + " is not among " + match.allow),
            request
        );
        response.headers.emplace_back("Allow", match.allow);
        return response;
    }
    request.route = match.route->path;
    request.resource_id = match.id;
    if (auto refusal = admission_.admit(request, need_of(*match.route))) {
        return refusal;
    }
    if (request.content_length > body_bytes_max(request)) {
        return problem_response(
            make_problem(
                "body-too-large",
                "the body may have " + std::to_string(body_bytes_max(request)) + " bytes"
            ),
            request
        );
    }
    const std::string coding = lower_case(request.header_list("content-encoding").value_or(""));
    if (!coding.empty() && coding != "identity") {
        Response response = problem_response(
            make_problem("unsupported-media-type", "bodies are taken as they are, not coded"),
            request
        );
        response.headers.emplace_back("Accept-Encoding", "identity");
        return response;
    }
    if (match.route->body != BodyKind::kOther && !is_taken(request, match.route->body)) {
        const bool is_upload = match.route->body == BodyKind::kUpload;
        const std::string taken =
            is_upload ? "application/json or model/gltf-binary" : "application/json";
        Response response = problem_response(
            make_problem(
                "unsupported-media-type",
                "the body must be " + taken + "; curl sends JSON with -H " +
                    "'Content-Type: application/json'"
            ),
            request
        );
        response.headers.emplace_back(
            "Accept", is_upload ? "application/json, model/gltf-binary" : "application/json"
        );
        return response;
    }
    return std::nullopt;
}

Response Api::handle(const Request& request) {
    Match match = find_route(request);
    // Of what belongs to another key nobody learns more than of what is not there.
    if (!request.caller.sees_all &&
        std::string_view(match.route->path).starts_with("/v1/jobs/{id}")) {
        if (const auto job = service_.find(match.id, request.caller); !job) {
            return problem_response(job.error(), request);
        }
    }
    if (takes_no_query(*match.route)) {
        if (auto problem = check_no_query(request)) {
            return problem_response(*problem, request);
        }
    }
    Response response = match.route->handler(
        {service_, admission_, metrics_, request, std::move(match.id), documents_}
    );
    if (!response.wait) {
        code_body(request, response);
    }
    return response;
}

Response Api::answer_with_job(
    const Request& request, const Response& held, const WaitForJob& wait
) {
    const auto job = service_.find(wait.job_id);
    if (!job) {
        return problem_response(job.error(), request);
    }
    if (request.method != "POST") {
        return respond_with_json(request, proto::to_json(*job));
    }
    Response response = json_response(
        proto::is_ended(job->state) ? wait.status_ended : wait.status_unfinished,
        proto::to_json(*job)
    );
    for (const auto& field : held.headers) {
        if (field.first != "Content-Type") {
            response.headers.push_back(field);
        }
    }
    code_body(request, response);
    return response;
}

}  // namespace modelsynth::server
