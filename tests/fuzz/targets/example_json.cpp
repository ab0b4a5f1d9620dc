// The body of POST /v1/examples as JSON.

#include "proto/example_codec.h"
#include "tests/fuzz/targets/law.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace proto = modelsynth::proto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto parsed = proto::parse_example({reinterpret_cast<const char*>(data), size}, {});
    if (!parsed) {
        law(!proto::to_json(parsed.error()).empty());
        return 0;
    }
    const auto again = proto::parse_example(parsed->canonical, {});
    law(again && again->canonical == parsed->canonical);
    return 0;
}
