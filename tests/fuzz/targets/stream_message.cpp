// What a client sends on GET /v1/stream.

#include "proto/stream_message.h"

#include "tests/fuzz/targets/law.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace proto = modelsynth::proto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto request = proto::parse_stream_request(text);
    if (!request) {
        law(!proto::refusal_json(request.error()).empty());
        return 0;
    }
    switch (request->type) {
        case proto::StreamRequestType::kSubscribe:
            law(!proto::subscribed_json(*request, 1).empty());
            break;
        case proto::StreamRequestType::kUnsubscribe:
            law(!proto::unsubscribed_json(*request, 1).empty());
            break;
        case proto::StreamRequestType::kCancel:
            law(!proto::cancelled_json(*request, "running").empty());
            break;
    }
    return 0;
}
