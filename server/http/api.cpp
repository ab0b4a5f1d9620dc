#include "server/http/api.h"

#include "proto/example_codec.h"
#include "proto/job.h"
#include "server/http/representation.h"
#include "solver/mesh/glb_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <initializer_list>
#include <utility>

namespace modelsynth::server {

namespace {

using proto::make_problem;
using proto::Parsed;
using proto::Problem;

// A request in the hands of its handler.
struct Call {
    JobService& service;
    const Request& request;
    std::string id;  // the {id} of the path, if it has one
};

using Handler = Response (*)(const Call&);

struct Route {
    const char* method;
    const char* path;  // segments, {} stands for an id
    Handler handler;
};

Response refuse(const Call& call, const Problem& problem) {
    return problem_response(problem, call.request);
}

std::optional<std::uint64_t> parse_number(const std::string& text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    if (text.empty() || parsed.ec != std::errc() || parsed.ptr != end) {
        return std::nullopt;
    }
    return value;
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    });
    return text;
}

// The items of a comma-separated list, white space and what is quoted left out.
std::vector<std::string> list_items(const std::string& list) {
    std::vector<std::string> items(1);
    bool quoted = false;
    for (const char c : list) {
        if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && c == ',') {
            items.emplace_back();
        } else if (!quoted && c != ' ' && c != '\t') {
            items.back() += c;
        }
    }
    return items;
}

// A query field that nobody knows is mistyped; leaving it out would answer another question.
std::optional<Problem> check_query(
    const Request& request, std::initializer_list<std::string_view> known
) {
    for (std::size_t i = 0; i < request.query.size(); ++i) {
        const std::string& name = request.query[i].first;
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            return make_problem(
                "malformed-request", "there is no query parameter \"" + name.substr(0, 64) + "\""
            );
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (request.query[j].first == name) {
                return make_problem(
                    "malformed-request", "the query parameter \"" + name + "\" stands twice"
                );
            }
        }
    }
    return std::nullopt;
}

Parsed<std::uint64_t> query_number(
    const Request& request,
    std::string_view name,
    std::uint64_t otherwise,
    std::uint64_t min,
    std::uint64_t max
) {
    const auto text = request.query_field(name);
    if (!text) {
        return otherwise;
    }
    const auto value = parse_number(*text);
    if (!value) {
        return tl::unexpected(make_problem(
            "malformed-request", "\"" + std::string(name) + "\" must be a whole number"
        ));
    }
    if (*value < min || *value > max) {
        return tl::unexpected(make_problem(
            "invalid-request",
            "\"" + std::string(name) + "\" must be from " + std::to_string(min) + " to " +
                std::to_string(max)
        ));
    }
    return *value;
}

Representation glb_in_memory(std::string glb, std::string file_name) {
    Representation representation;
    representation.media_type = "model/gltf-binary";
    representation.etag = "\"" + sha256_hex(glb) + "\"";
    representation.file_name = std::move(file_name);
    representation.content = std::move(glb);
    return representation;
}

// --- jobs

// wait=N of a Prefer header (RFC 7240), capped; a malformed preference is ignored.
std::optional<std::uint64_t> preferred_wait(const Request& request) {
    constexpr std::uint64_t kMost = 60;
    for (const std::string& part : list_items(request.header_list("prefer").value_or(""))) {
        const std::string preference = lower_case(part.substr(0, part.find(';')));
        if (!preference.starts_with("wait=")) {
            continue;
        }
        const std::string digits = preference.substr(5);
        if (!digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos) {
            return std::min(kMost, parse_number(digits).value_or(kMost));
        }
    }
    return std::nullopt;
}

Parsed<std::string> idempotency_key(const Request& request) {
    std::string key = request.header("idempotency-key").value_or("");
    if (key.size() >= 2 && key.front() == '"' && key.back() == '"') {
        key = key.substr(1, key.size() - 2);
    }
    const bool printable =
        std::all_of(key.begin(), key.end(), [](char c) { return c > 0x20 && c < 0x7F; });
    if (key.size() > 255 || !printable ||
        (key.empty() && request.header("idempotency-key").has_value())) {
        return tl::unexpected(make_problem(
            "malformed-request", "an Idempotency-Key has 1 to 255 visible ASCII characters"
        ));
    }
    return key;
}

Response submit_job(const Call& call) {
    if (auto problem = check_query(call.request, {})) {
        return refuse(call, *problem);
    }
    const auto key = idempotency_key(call.request);
    if (!key) {
        return refuse(call, key.error());
    }
    const auto submitted = call.service.submit(call.request.body, *key);
    if (!submitted) {
        return refuse(call, submitted.error());
    }
    Response response = json_response(202, proto::to_json(submitted->job));
    response.headers.emplace_back("Location", "/v1/jobs/" + submitted->job.id);
    if (submitted->replayed) {
        response.headers.emplace_back("Idempotent-Replayed", "true");
    }
    if (const auto seconds = preferred_wait(call.request)) {
        response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*seconds));
        response.wait = WaitForJob{submitted->job.id, std::chrono::seconds(*seconds), 200, 202};
    }
    return response;
}

Response list_jobs(const Call& call) {
    if (auto problem = check_query(call.request, {"state", "limit", "cursor"})) {
        return refuse(call, *problem);
    }
    JobQuery query;
    if (const auto state = call.request.query_field("state")) {
        query.state = proto::state_of(*state);
        if (!query.state) {
            return refuse(
                call,
                make_problem(
                    "invalid-request",
                    "\"state\" must be queued, running, succeeded, failed or cancelled"
                )
            );
        }
    }
    const auto limit = query_number(call.request, "limit", 20, 1, 100);
    if (!limit) {
        return refuse(call, limit.error());
    }
    query.limit = *limit;
    query.cursor = call.request.query_field("cursor").value_or("");
    const auto page = call.service.list(query);
    if (!page) {
        return refuse(call, page.error());
    }
    std::vector<std::string> items;
    for (const proto::Job& job : page->jobs) {
        items.push_back(proto::to_json(job));
    }
    return json_response(200, proto::list_json(items, page->next));
}

Response get_job(const Call& call) {
    const auto job = call.service.find(call.id);
    return job ? json_response(200, proto::to_json(*job)) : refuse(call, job.error());
}

Response cancel_job(const Call& call) {
    const auto job = call.service.cancel(call.id);
    if (!job) {
        return refuse(call, job.error());
    }
    Response response = json_response(200, proto::to_json(*job));
    if (!proto::is_ended(job->state)) {
        response.wait = WaitForJob{call.id, std::chrono::seconds(1), 200, 200};
    }
    return response;
}

Response delete_job(const Call& call) {
    const auto erased = call.service.erase(call.id);
    if (!erased) {
        return refuse(call, erased.error());
    }
    return {204, {}, std::string()};
}

Response get_model(const Call& call) {
    if (auto problem = check_query(call.request, {"profile", "compression"})) {
        return refuse(call, *problem);
    }
    static constexpr std::array<std::pair<std::string_view, GlbProfile>, 3> kProfiles = {
        {{"nodes", GlbProfile::kNodes},
         {"instanced", GlbProfile::kInstanced},
         {"merged", GlbProfile::kMerged}}};
    const std::string name = call.request.query_field("profile").value_or("nodes");
    const auto profile = std::find_if(kProfiles.begin(), kProfiles.end(), [&](const auto& known) {
        return known.first == name;
    });
    if (profile == kProfiles.end()) {
        return refuse(
            call, make_problem("invalid-request", "\"profile\" must be nodes, instanced or merged")
        );
    }
    if (call.request.query_field("compression").value_or("none") != "none") {
        return refuse(
            call, make_problem("invalid-request", "\"compression\" must be none in this version")
        );
    }
    const auto digest = call.service.model_digest(call.id, profile->second);
    if (!digest) {
        return refuse(call, digest.error());
    }
    auto reader = call.service.artifacts().open(*digest);
    if (!reader) {
        return refuse(call, make_problem("not-found", "the model was deleted"));
    }
    Representation representation;
    representation.media_type = "model/gltf-binary";
    representation.etag = "\"" + *digest + "\"";
    representation.file_name = call.id + ".glb";
    representation.content = std::shared_ptr<ArtifactStore::Reader>(std::move(*reader));
    return respond_with(call.request, std::move(representation));
}

Response get_preview(const Call& call) {
    auto glb = call.service.preview(call.id);
    if (!glb) {
        return refuse(call, glb.error());
    }
    return respond_with(call.request, glb_in_memory(std::move(*glb), call.id + ".preview.glb"));
}

Response get_labels(const Call& call) {
    auto labels = call.service.labels_json(call.id);
    if (!labels) {
        return refuse(call, labels.error());
    }
    Representation representation;
    representation.media_type = "application/json";
    representation.etag = "\"" + sha256_hex(*labels) + "\"";
    representation.content = std::move(*labels);
    return respond_with(call.request, std::move(representation));
}

// Where the client wants to go on: Last-Event-ID wins over `after`, since a browser sends it on
// reconnecting while its URL still says the old `after`.
Parsed<std::uint64_t> start_of_events(const Call& call) {
    auto after = query_number(call.request, "after", 0, 0, proto::kSeedMax);
    if (!after) {
        return after;
    }
    if (const auto last = call.request.header("last-event-id")) {
        const auto value = parse_number(*last);
        if (!value) {
            return tl::unexpected(
                make_problem("malformed-request", "Last-Event-ID must be a whole number")
            );
        }
        after = *value;
    }
    const auto page = call.service.events().read(call.id, 0, 0);
    if (!page) {
        return tl::unexpected(make_problem("not-found", "there is no job " + call.id));
    }
    if (*after > page->head) {
        return tl::unexpected(make_problem(
            "invalid-request",
            "the log ends at " + std::to_string(page->head) + ", before " + std::to_string(*after)
        ));
    }
    return after;
}

Response get_events(const Call& call) {
    if (auto problem = check_query(call.request, {"after"})) {
        return refuse(call, *problem);
    }
    const auto after = start_of_events(call);
    if (!after) {
        return refuse(call, after.error());
    }
    // A browser that reconnects after the end is told to stop, which 204 does.
    const auto page = call.service.events().read(call.id, 0, 0);
    if (page && page->ended && *after == page->head) {
        return {204, {}, std::string()};
    }
    Response response;
    response.headers = {
        {"Content-Type", "text/event-stream"},
        {"Cache-Control", "no-store"},
        {"X-Accel-Buffering", "no"}};
    response.body = EventStreamBody{call.id, *after};
    return response;
}

// What must hold before the connection becomes a WebSocket (RFC 6455 4.2.1); nothing: it does.
std::optional<Response> check_handshake(const Call& call) {
    const Request& request = call.request;
    const auto has = [&request](std::string_view name, std::string_view wanted) {
        for (const std::string& item : list_items(request.header_list(name).value_or(""))) {
            if (lower_case(item) == wanted) {
                return true;
            }
        }
        return false;
    };
    const auto upgrade_required = [&call](const char* detail) {
        Response response = refuse(call, {"about:blank", "Upgrade Required", 426, detail, {}, {}});
        response.headers.emplace_back("Upgrade", "websocket");
        response.headers.emplace_back("Sec-WebSocket-Version", "13");
        return response;
    };
    if (!has("upgrade", "websocket") || !has("connection", "upgrade")) {
        return upgrade_required("this resource speaks WebSocket only");
    }
    if (request.header("sec-websocket-version") != "13") {
        return upgrade_required("the version of WebSocket is 13");
    }
    const std::string key = request.header("sec-websocket-key").value_or("");
    static constexpr const char* kBase64 =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (key.size() != 24 || key.find_first_not_of(kBase64) != 22 || !key.ends_with("==")) {
        return refuse(
            call, make_problem("malformed-request", "Sec-WebSocket-Key must be 16 bytes in base64")
        );
    }
    const auto offered = list_items(request.header_list("sec-websocket-protocol").value_or(""));
    if (std::find(offered.begin(), offered.end(), "modelsynth.v1") == offered.end()) {
        return refuse(
            call, make_problem("malformed-request", "the subprotocol modelsynth.v1 must be offered")
        );
    }
    return std::nullopt;
}

Response get_stream(const Call& call) {
    if (auto problem = check_query(call.request, {"after", "partial"})) {
        return refuse(call, *problem);
    }
    if (auto refusal = check_handshake(call)) {
        return *refusal;
    }
    const auto after = start_of_events(call);
    if (!after) {
        return refuse(call, after.error());
    }
    const std::string name = call.request.query_field("partial").value_or("none");
    if (name != "none" && name != "labels" && name != "glb") {
        return refuse(
            call, make_problem("invalid-request", "\"partial\" must be none, labels or glb")
        );
    }
    Response response;
    response.status = 101;
    response.body = SocketUpgrade{
        call.id,
        *after,
        name == "labels" ? Partial::kLabels
        : name == "glb"  ? Partial::kGlb
                         : Partial::kNone};
    return response;
}

// --- examples

Response list_examples(const Call& call) {
    const auto entries = call.service.examples().list();
    if (!entries) {
        return refuse(call, entries.error());
    }
    std::vector<std::string> items;
    for (const auto& entry : *entries) {
        items.push_back(proto::example_summary(entry.example, entry.id, entry.built_in));
    }
    return json_response(200, proto::list_json(items, std::nullopt));
}

Response upload_example(const Call& call) {
    const auto entry = call.service.examples().upload(call.request.body);
    if (!entry) {
        return refuse(call, entry.error());
    }
    Response response =
        json_response(201, proto::example_resource(entry->example, entry->id, entry->built_in));
    response.headers.emplace_back("Location", "/v1/examples/" + entry->id);
    return response;
}

Response no_example(const Call& call) {
    return refuse(call, make_problem("not-found", "there is no example " + call.id.substr(0, 64)));
}

Response get_example(const Call& call) {
    const auto entry = call.service.examples().find(call.id);
    if (!entry) {
        return no_example(call);
    }
    return json_response(200, proto::example_resource(entry->example, entry->id, entry->built_in));
}

Response delete_example(const Call& call) {
    const auto erased = call.service.examples().erase(call.id);
    if (!erased) {
        return refuse(call, erased.error());
    }
    return {204, {}, std::string()};
}

Response example_glb(const Call& call, const Scene& scene, bool named_nodes, const char* suffix) {
    GlbOptions options;
    options.named_nodes = named_nodes;
    auto glb = write_glb(scene, options);
    if (!glb) {
        return refuse(call, proto::problem_of(glb.error()));
    }
    return respond_with(call.request, glb_in_memory(std::move(*glb), call.id + suffix));
}

Response get_example_model(const Call& call) {
    const auto entry = call.service.examples().find(call.id);
    if (!entry) {
        return no_example(call);
    }
    return example_glb(call, example_scene(entry->example), false, ".glb");
}

Response get_example_pieces(const Call& call) {
    const auto entry = call.service.examples().find(call.id);
    if (!entry) {
        return no_example(call);
    }
    return example_glb(call, pieces_scene(entry->example), true, ".pieces.glb");
}

// --- the rest

Response list_solvers(const Call& /*call*/) {
    return json_response(200, proto::solver_list_json());
}

Response get_solver(const Call& call) {
    std::string solver = proto::solver_json(call.id);
    if (solver.empty()) {
        return refuse(
            call, make_problem("not-found", "there is no solver " + call.id.substr(0, 64))
        );
    }
    return json_response(200, std::move(solver));
}

Response healthz(const Call& /*call*/) { return json_response(200, R"({"status":"alive"})"); }

Response readyz(const Call& call) {
    if (call.service.is_ready()) {
        return json_response(200, R"({"status":"ready"})");
    }
    return refuse(
        call,
        call.service.is_draining() ? make_problem("draining", "the server is stopping")
                                   : make_problem("queue-full", "no work is taken right now")
    );
}

Response get_problem(const Call& call) {
    for (const proto::ProblemKind& kind : proto::problem_kinds()) {
        if (call.id == kind.name) {
            return {
                200,
                {{"Content-Type", "text/plain; charset=utf-8"}},
                std::string(kind.title) + "\n\n" + kind.explanation + "\n"};
        }
    }
    return refuse(call, make_problem("not-found", "there is no such problem"));
}

constexpr std::array<Route, 21> kRoutes = {
    {{"POST", "/v1/jobs", submit_job},
     {"GET", "/v1/jobs", list_jobs},
     {"GET", "/v1/jobs/{}", get_job},
     {"DELETE", "/v1/jobs/{}", delete_job},
     {"POST", "/v1/jobs/{}/cancel", cancel_job},
     {"GET", "/v1/jobs/{}/model.glb", get_model},
     {"GET", "/v1/jobs/{}/preview.glb", get_preview},
     {"GET", "/v1/jobs/{}/labels.json", get_labels},
     {"GET", "/v1/jobs/{}/events", get_events},
     {"GET", "/v1/jobs/{}/stream", get_stream},
     {"GET", "/v1/examples", list_examples},
     {"POST", "/v1/examples", upload_example},
     {"GET", "/v1/examples/{}", get_example},
     {"DELETE", "/v1/examples/{}", delete_example},
     {"GET", "/v1/examples/{}/model.glb", get_example_model},
     {"GET", "/v1/examples/{}/pieces.glb", get_example_pieces},
     {"GET", "/v1/solvers", list_solvers},
     {"GET", "/v1/solvers/{}", get_solver},
     {"GET", "/healthz", healthz},
     {"GET", "/readyz", readyz},
     {"GET", "/problems/{}", get_problem}}};

// Whether the path is the route's; the id that it carries goes to `id`.
bool matches(const char* route, const std::vector<std::string>& path, std::string& id) {
    std::string_view rest = route;
    std::string found;
    for (const std::string& segment : path) {
        if (rest.empty()) {
            return false;
        }
        rest.remove_prefix(1);
        const std::string_view wanted = rest.substr(0, rest.find('/'));
        if (wanted == "{}" && !segment.empty()) {
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

bool takes_json(const Request& request) {
    const auto type = request.header("content-type");
    if (!type) {
        return true;
    }
    std::string media = type->substr(0, type->find(';'));
    media.erase(std::remove(media.begin(), media.end(), ' '), media.end());
    return lower_case(media) == "application/json";
}

}  // namespace

std::uint64_t Api::body_bytes_max(const Request& request) const {
    if (request.method == "POST" && request.path == std::vector<std::string>{"v1", "jobs"}) {
        return limits_.job_body_bytes_max;
    }
    if (request.method == "POST" && request.path == std::vector<std::string>{"v1", "examples"}) {
        return limits_.upload_body_bytes_max;
    }
    return limits_.other_body_bytes_max;
}

std::optional<Response> Api::check_head(const Request& request) const {
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
    if (request.content_length > body_bytes_max(request)) {
        return problem_response(
            make_problem(
                "body-too-large",
                "the body may have " + std::to_string(body_bytes_max(request)) + " bytes"
            ),
            request
        );
    }
    const bool wants_json =
        match.route->handler == submit_job || match.route->handler == upload_example;
    if (wants_json && !takes_json(request)) {
        Response response = problem_response(
            make_problem(
                "unsupported-media-type",
                "the body must be application/json; curl sends that with -H "
                "'Content-Type: application/json'"
            ),
            request
        );
        response.headers.emplace_back("Accept", "application/json");
        return response;
    }
    return std::nullopt;
}

Response Api::handle(const Request& request) {
    Match match = find_route(request);
    if (match.route == nullptr) {
        return *check_head(request);
    }
    return match.route->handler({service_, request, std::move(match.id)});
}

Response Api::answer_with_job(
    const Request& request, const Response& held, const WaitForJob& wait
) {
    const auto job = service_.find(wait.job_id);
    if (!job) {
        return problem_response(job.error(), request);
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
    return response;
}

}  // namespace modelsynth::server
