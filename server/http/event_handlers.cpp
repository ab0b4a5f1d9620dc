#include "proto/job_request.h"
#include "server/http/handlers.h"
#include "server/http/query_reader.h"
#include "server/http/request_fields.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

using proto::make_problem;
using proto::Parsed;

namespace {

// Where the client wants to go on: Last-Event-ID wins over `after`, since a browser sends it on
// reconnecting while its URL still says the old `after`.
Parsed<std::uint64_t> start_of_events(const Call& call, std::optional<std::uint64_t> after) {
    if (const auto last = call.request.header("last-event-id")) {
        const auto value = parse_number(*last);
        if (!value && !is_whole_number(*last)) {
            return tl::unexpected(
                make_problem("malformed-request", "Last-Event-ID must be a whole number")
            );
        }
        after = value.value_or(proto::kSeedMax);
    }
    const auto page = call.service.events().read(call.id, 0, 0);
    if (!page) {
        return tl::unexpected(make_problem("not-found", "there is no job " + call.id));
    }
    if (after.value_or(0) > page->head) {
        return tl::unexpected(make_problem(
            "invalid-request",
            "the log ends at " + std::to_string(page->head) + ", before " + std::to_string(*after)
        ));
    }
    return after.value_or(0);
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
    if (request.method != "GET" || !has("upgrade", "websocket") || !has("connection", "upgrade")) {
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

// Whether the labels of the job's model stand in the cells of a grid.
bool has_cells(const Call& call) {
    const auto job = call.service.find(call.id);
    return !job || solver_has_cells(job->solver);
}

Response upgrade(SocketUpgrade to) {
    Response response;
    response.status = 101;
    response.body = std::move(to);
    return response;
}

}  // namespace

Response get_events(const Call& call) {
    QueryReader query(call.request);
    const auto given = query.number("after", 0, proto::kSeedMax);
    if (auto problem = query.finish()) {
        return refuse(call, *problem);
    }
    const auto after = start_of_events(call, given);
    if (!after) {
        return refuse(call, after.error());
    }
    // A browser that reconnects after the end is told to stop, which 204 does.
    const auto page = call.service.events().read(call.id, 0, 0);
    if (page && page->ended && *after == page->head) {
        return {204, {}, std::string()};
    }
    return event_stream_response({call.id, *after, false});
}

Response event_stream_response(EventStreamBody body) {
    Response response;
    response.headers = {
        {"Content-Type", "text/event-stream"},
        {"Cache-Control", "no-store"},
        {"X-Accel-Buffering", "no"}};
    response.body = std::move(body);
    return response;
}

Response get_stream(const Call& call) {
    QueryReader query(call.request);
    const auto given = query.number("after", 0, proto::kSeedMax);
    const auto partial = proto::partial_of(query.text("partial").value_or("none"));
    if (!partial) {
        query.fault("partial", "must be none, labels or glb");
    }
    if (partial == proto::Partial::kLabels && !has_cells(call)) {
        query.fault("partial", "must be none or glb, since the job's model has no cells");
    }
    if (auto problem = query.finish()) {
        return refuse(call, *problem);
    }
    if (auto refusal = check_handshake(call)) {
        return *refusal;
    }
    const auto after = start_of_events(call, given);
    if (!after) {
        return refuse(call, after.error());
    }
    return upgrade({JobStream{call.id, *after, *partial}});
}

Response get_shared_stream(const Call& call) {
    if (auto refusal = check_handshake(call)) {
        return *refusal;
    }
    const auto& key = call.request.key;
    return upgrade({std::nullopt, call.request.caller, !key || may(*key, proto::Scope::kSubmit)});
}

}  // namespace modelsynth::server
