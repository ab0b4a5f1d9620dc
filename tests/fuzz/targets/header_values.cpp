// Header values that are parsed by hand: lines of `name: value` besides the request's, about a
// resource of some bytes.

#include "server/http/content_coding.h"
#include "server/http/message.h"
#include "server/http/representation.h"
#include "server/http/request_fields.h"
#include "tests/fuzz/targets/law.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

using namespace modelsynth;

namespace {

server::Request request_of(std::string_view text) {
    server::Request request;
    request.method = "GET";
    request.target = "/";
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        const std::size_t colon = std::min(line.find(": "), line.size());
        if (colon < line.size()) {
            request.headers.emplace_back(line.substr(0, colon), line.substr(colon + 2));
        }
    }
    return request;
}

// A part is one of the whole, and says which.
void check_part(const server::Response& response, const std::string& whole) {
    const auto& part = std::get<std::string>(response.body);
    law(!part.empty());
    std::size_t first = whole.size();
    for (const auto& [name, value] : response.headers) {
        if (name == "Content-Range") {
            first = std::stoul(value.substr(value.find(' ') + 1));
            law(value == "bytes " + std::to_string(first) + "-" +
                             std::to_string(first + part.size() - 1) + "/" +
                             std::to_string(whole.size()));
        }
    }
    law(whole.compare(first, part.size(), part) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const server::Request request = request_of({reinterpret_cast<const char*>(data), size});
    for (const std::size_t length : {std::size_t{0}, std::size_t{10}, std::size_t{2000}}) {
        std::string whole(length, 'x');
        for (std::size_t i = 0; i < length; ++i) {
            whole[i] = static_cast<char>('a' + i % 26);
        }
        const server::Response response =
            server::respond_with(request, server::in_memory("text/plain", whole));
        law(response.status == 200 || response.status == 206 || response.status == 304 ||
            response.status == 406 || response.status == 412 || response.status == 416);
        if (response.status == 206) {
            check_part(response, whole);
        }
    }
    const auto accepted = server::parse_accept_encoding(request.header_list("accept-encoding"));
    law(accepted.gzip || !accepted.prefers_gzip);
    const auto wait = server::preferred_wait(request);
    law(!wait || *wait <= server::kWaitSecondsMax);
    static_cast<void>(server::wants_event_stream(request));
    const auto key = server::idempotency_key(request);
    law(!key || key->size() <= server::kIdempotencyKeyCharactersMax);
    static_cast<void>(server::media_type(request));
    return 0;
}
