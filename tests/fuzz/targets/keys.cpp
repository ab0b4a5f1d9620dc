// The file of keys, and the body of POST /v1/tickets.

#include "proto/key_codec.h"
#include "tests/fuzz/targets/law.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace proto = modelsynth::proto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto keys = proto::parse_keys(text);
    law(keys ? keys->size() <= proto::kKeysMax : !proto::to_json(keys.error()).empty());
    const auto ticket = proto::parse_ticket_request(text);
    law(ticket || !proto::to_json(ticket.error()).empty());
    return 0;
}
