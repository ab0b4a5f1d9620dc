// The body of POST /v1/jobs.

#include "proto/job_request.h"

#include "tests/fuzz/targets/law.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace proto = modelsynth::proto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto find_nothing = [](const std::string& /*id*/) -> std::optional<modelsynth::Example> {
        return std::nullopt;
    };
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto parsed = proto::parse_job_request(text, {}, find_nothing, nullptr, 1);
    if (!parsed) {
        law(!proto::to_json(parsed.error()).empty());
        return 0;
    }
    // The echo reproduces the job: it is accepted and says the same.
    const auto again = proto::parse_job_request(parsed->echo, {}, find_nothing, nullptr, 2);
    law(again && again->echo == parsed->echo);
    return 0;
}
