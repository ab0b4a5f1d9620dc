// The binary frames of the WebSockets, as a client in C++ decodes them.

#include "proto/frame.h"

#include "tests/fuzz/targets/law.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace proto = modelsynth::proto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (const auto frame = proto::decode_frame(bytes)) {
        law(proto::encode_frame(*frame) == bytes);
        static_cast<void>(proto::decode_labels(frame->payload));
    }
    if (const auto named = proto::decode_named_frame(bytes)) {
        law(proto::encode_frame_head(named->frame, named->job_id) + named->frame.payload == bytes);
    }
    return 0;
}
