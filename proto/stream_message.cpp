#include "proto/stream_message.h"

#include "proto/job.h"
#include "proto/json.h"

#include <array>
#include <utility>

namespace modelsynth::proto {

namespace {

constexpr std::size_t kJobIdCharactersMax = 128;
constexpr std::array<const char*, 3> kTypes = {"subscribe", "unsubscribe", "cancel"};
constexpr std::array<const char*, 3> kPartials = {"none", "labels", "glb"};

// A message is short, so it holds little.
constexpr JsonLimits kMessageLimits = {8, 256, kStreamMessageBytesMax};

const char* type_of(const StreamRequest& request) {
    return kTypes.at(static_cast<std::size_t>(request.type));
}

std::optional<std::string> read_name(const Value& value, std::size_t characters_max) {
    auto text = value.string(characters_max);
    if (text && text->empty()) {
        value.fault("must not be empty");
        text.reset();
    }
    return text;
}

// The id as JSON text, when it is one.
std::optional<std::string> read_id(const Value& value) {
    if (value.json().is_string()) {
        const auto text = read_name(value, kRequestIdCharactersMax);
        return text ? std::optional(dump(value.json())) : std::nullopt;
    }
    if (value.json().is_number()) {
        const auto number = value.integer(0, static_cast<std::int64_t>(kSeedMax));
        return number ? std::optional(std::to_string(*number)) : std::nullopt;
    }
    value.fault("must be a string or a whole number");
    return std::nullopt;
}

void read_subscription(ObjectReader& reader, StreamRequest& request) {
    if (const auto after = reader.optional("after")) {
        const auto seq = after->integer(0, static_cast<std::int64_t>(kSeedMax));
        request.after = static_cast<std::uint64_t>(seq.value_or(0));
    }
    if (const auto partial = reader.optional("partial")) {
        request.partial = static_cast<Partial>(partial->one_of(kPartials).value_or(0));
    }
}

OrderedJson answer_of(const StreamRequest& request) {
    return {
        {"type", "answer"},
        {"id", OrderedJson::parse(request.id)},
        {"request", type_of(request)},
        {"job_id", request.job_id}};
}

}  // namespace

std::optional<Partial> partial_of(std::string_view name) {
    for (std::size_t i = 0; i < kPartials.size(); ++i) {
        if (name == kPartials.at(i)) {
            return static_cast<Partial>(i);
        }
    }
    return std::nullopt;
}

tl::expected<StreamRequest, StreamRefusal> parse_stream_request(std::string_view text) {
    const auto document = parse_json(text, kMessageLimits);
    if (!document) {
        return tl::unexpected(StreamRefusal{"null", document.error()});
    }
    Faults faults;
    const Value root(*document, "", faults);
    ObjectReader reader(root);
    StreamRequest request;
    std::optional<std::string> id;
    if (const auto value = reader.required("id")) {
        id = read_id(*value);
    }
    if (const auto value = reader.required("job")) {
        request.job_id = read_name(*value, kJobIdCharactersMax).value_or("");
    }
    std::optional<std::size_t> type;
    if (const auto value = reader.required("type")) {
        type = value->one_of(kTypes);
    }
    // What else may stand there depends on the type.
    if (type) {
        request.type = static_cast<StreamRequestType>(*type);
        if (request.type == StreamRequestType::kSubscribe) {
            read_subscription(reader, request);
        }
        reader.finish();
    }
    if (!faults.empty()) {
        Problem problem = make_problem("invalid-request", "the message cannot be done");
        problem.errors = faults.take();
        return tl::unexpected(StreamRefusal{id.value_or("null"), std::move(problem)});
    }
    request.id = *id;
    return request;
}

std::string subscribed_json(const StreamRequest& request, std::uint64_t head) {
    OrderedJson answer = answer_of(request);
    answer["after"] = request.after;
    answer["head"] = head;
    return dump(answer);
}

std::string unsubscribed_json(const StreamRequest& request, std::uint64_t seq) {
    OrderedJson answer = answer_of(request);
    answer["seq"] = seq;
    return dump(answer);
}

std::string cancelled_json(const StreamRequest& request, std::string_view state) {
    OrderedJson answer = answer_of(request);
    answer["state"] = std::string(state);
    return dump(answer);
}

std::string refusal_json(const StreamRefusal& refusal) {
    const OrderedJson message = {
        {"type", "refusal"},
        {"id", OrderedJson::parse(refusal.id)},
        {"error", OrderedJson::parse(to_json(refusal.problem))}};
    return dump(message);
}

std::string stream_end_json(const std::string& job_id, StreamEndReason reason, std::uint64_t seq) {
    const OrderedJson message = {
        {"type", "end"},
        {"job_id", job_id},
        {"reason", reason == StreamEndReason::kEnded ? "ended" : "deleted"},
        {"seq", seq}};
    return dump(message);
}

std::string event_json(
    const std::string& job_id,
    std::uint64_t seq,
    std::string_view type,
    UnixMillis time,
    std::string_view fields
) {
    return "{\"job_id\":" + dump(Json(job_id)) + "," +
           event_json(seq, type, time, fields).substr(1);
}

}  // namespace modelsynth::proto
