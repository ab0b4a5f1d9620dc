#pragma once

#include "proto/problem.h"
#include "proto/timestamp.h"

#include <tl/expected.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// The text messages of the WebSocket for many jobs, see streams.md. Their schemas are
// schemas/stream.client.json and schemas/stream.server.json.

namespace modelsynth::proto {

// What a client may send in one message, and the longest id of a request in it.
inline constexpr std::size_t kStreamMessageBytesMax = 4096;
inline constexpr std::size_t kRequestIdCharactersMax = 64;

// Which frames of what blocks changed go with the events of a job.
enum class Partial : std::uint8_t { kNone, kLabels, kGlb };

// Nothing when there is no such thing.
[[nodiscard]] std::optional<Partial> partial_of(std::string_view name);

enum class StreamRequestType : std::uint8_t { kSubscribe, kUnsubscribe, kCancel };

struct StreamRequest {
    std::string id;  // JSON text, the client's own name of the request
    StreamRequestType type = StreamRequestType::kSubscribe;
    std::string job_id;
    std::uint64_t after = 0;  // of kSubscribe, as is the next
    Partial partial = Partial::kNone;
};

// Why a request was not done.
struct StreamRefusal {
    std::string id;  // JSON text, "null" when the message has none that can be read
    Problem problem;
};

// Reads a message of a client whole or says all that is wrong with it.
[[nodiscard]] tl::expected<StreamRequest, StreamRefusal> parse_stream_request(std::string_view text
);

// Answers. Require: a request of that type.
[[nodiscard]] std::string subscribed_json(const StreamRequest& request, std::uint64_t head);
// `seq`: of the last event that was sent.
[[nodiscard]] std::string unsubscribed_json(const StreamRequest& request, std::uint64_t seq);
// `state`: the job's after it.
[[nodiscard]] std::string cancelled_json(const StreamRequest& request, std::string_view state);
[[nodiscard]] std::string refusal_json(const StreamRefusal& refusal);

enum class StreamEndReason : std::uint8_t { kEnded, kDeleted };

// That nothing more comes of a job. `seq`: of the last event that was sent.
[[nodiscard]] std::string stream_end_json(
    const std::string& job_id, StreamEndReason reason, std::uint64_t seq
);

// An event with the id of its job before its other fields; else as event_json() of job.h.
[[nodiscard]] std::string event_json(
    const std::string& job_id,
    std::uint64_t seq,
    std::string_view type,
    UnixMillis time,
    std::string_view fields
);

}  // namespace modelsynth::proto
