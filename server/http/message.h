#pragma once

#include "proto/key_codec.h"
#include "proto/problem.h"
#include "proto/stream_message.h"
#include "server/jobs/caller.h"
#include "server/store/artifact_store.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::server {

using Fields = std::vector<std::pair<std::string, std::string>>;

// A request, parsed and free of any library. Header names are in lower case.
struct Request {
    std::string method;
    std::string target;             // as it was sent
    std::vector<std::string> path;  // decoded segments: /v1/jobs -> {"v1", "jobs"}
    Fields query;                   // decoded
    Fields headers;
    std::string body;
    std::uint64_t content_length = 0;
    std::string id;                   // the client's own or ours, see correlation.h
    std::string traceparent;          // empty: none
    std::string_view route = "none";  // the template of its path, once it is known
    std::string resource_id;          // what stands for {id} in that
    Caller caller;
    std::shared_ptr<const proto::KeyEntry> key;  // that the request came with; null: none
    Fields answer_fields;                        // what every answer to it tells besides

    // The first header or query field of the name.
    [[nodiscard]] std::optional<std::string> header(std::string_view name) const;
    // All headers of the name as one list.
    [[nodiscard]] std::optional<std::string> header_list(std::string_view name) const;
    [[nodiscard]] std::optional<std::string> query_field(std::string_view name) const;
};

// Bytes of a stored file, streamed.
struct FileBody {
    std::shared_ptr<ArtifactStore::Reader> reader;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
};

// Server-Sent Events of a job.
struct EventStreamBody {
    std::string job_id;
    std::uint64_t after = 0;
    bool cancel_when_left = false;  // the client has no way to find the job again
};

// What a client wants to see of a job.
struct JobStream {
    std::string job_id;
    std::uint64_t after = 0;
    proto::Partial partial = proto::Partial::kNone;
};

// The connection becomes a WebSocket: of one job, or of those that the client will name, as far as
// it may know of them.
struct SocketUpgrade {
    std::optional<JobStream> job;
    Caller caller = {};
    bool may_cancel = true;
};

// The answer is held back until the job has ended or the time is up, or an event has come beyond
// `since` where that is given; then answer_with_job() makes it.
struct WaitForJob {
    std::string job_id;
    std::chrono::milliseconds most = {};
    int status_ended = 200;
    int status_unfinished = 202;
    std::optional<std::uint64_t> since = {};
    bool cancel_when_left = false;  // as above
};

struct Response {
    int status = 200;
    Fields headers;
    std::variant<std::string, FileBody, EventStreamBody, SocketUpgrade> body = std::string();
    std::optional<WaitForJob> wait = {};
    bool close = false;        // the connection cannot be used any more
    std::string job_id = {};   // that was made by the request
    std::string problem = {};  // the name of the problem that this is; empty: none
};

[[nodiscard]] Response json_response(int status, std::string body);
// The problem as application/problem+json, `instance` set to the request's target.
// Of one that passes it tells when to come back.
[[nodiscard]] Response problem_response(const proto::Problem& problem, const Request& request);

// Splits a request target into path and query and decodes both. False when it is malformed: neither
// in origin form nor in absolute form with a host, a broken escape, a NUL byte.
[[nodiscard]] bool parse_target(std::string_view target, Request& request);

}  // namespace modelsynth::server
