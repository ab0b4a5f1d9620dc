#include "server/http/head_check.h"

#include <algorithm>

namespace modelsynth::server {

namespace {

using proto::make_problem;
using proto::plain_problem;

std::size_t count_fields(const Request& request, std::string_view name) {
    return static_cast<std::size_t>(std::count_if(
        request.headers.begin(),
        request.headers.end(),
        [name](const auto& field) { return field.first == name; }
    ));
}

// Whether it is a host and perhaps a port (RFC 9112 3.2); empty is allowed. Commas, which a name
// might have, are not: they are what joins two fields to one.
bool is_authority(std::string_view text) {
    static constexpr std::string_view kDigits = "0123456789";
    static constexpr std::string_view kAddress = "0123456789abcdefABCDEF:.";
    static constexpr std::string_view kName =
        "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-._~%!$&'()*+;=";
    const bool is_address = text.starts_with('[');
    const std::size_t end = is_address ? text.find(']') : text.find(':');
    if (is_address && end == std::string_view::npos) {
        return false;
    }
    const std::string_view host =
        is_address ? text.substr(1, end - 1) : text.substr(0, std::min(end, text.size()));
    if (host.find_first_not_of(is_address ? kAddress : kName) != std::string_view::npos) {
        return false;
    }
    const std::string_view rest = text.substr(std::min(is_address ? end + 1 : end, text.size()));
    return rest.empty() ||
           (rest.front() == ':' && rest.find_first_not_of(kDigits, 1) == std::string_view::npos);
}

}  // namespace

std::optional<proto::Problem> check_raw_head(std::string_view head) {
    if (head.find("\r\n ") != std::string_view::npos ||
        head.find("\r\n\t") != std::string_view::npos) {
        return make_problem("malformed-request", "header lines must not be folded");
    }
    for (std::size_t i = 0; i < head.size(); ++i) {
        const bool lone_feed = head[i] == '\n' && (i == 0 || head[i - 1] != '\r');
        const bool lone_return = head[i] == '\r' && (i + 1 == head.size() || head[i + 1] != '\n');
        if (lone_feed || lone_return) {
            return make_problem("malformed-request", "lines end with CR LF, both of them");
        }
    }
    const std::string_view line = head.substr(0, head.find("\r\n"));
    if (std::any_of(line.begin(), line.end(), [](char c) {
            return static_cast<unsigned char>(c) > 0x7E;
        })) {
        return make_problem("malformed-request", "the request line has bytes beyond ASCII");
    }
    return std::nullopt;
}

std::optional<proto::Problem> check_framing(const Request& request, unsigned version) {
    const std::size_t hosts = count_fields(request, "host");
    if (hosts > 1 || (hosts == 0 && version == 11)) {
        return make_problem("malformed-request", "a request names exactly one Host");
    }
    if (hosts == 1 && !is_authority(*request.header("host"))) {
        return make_problem("malformed-request", "Host must be a name or an address, and a port");
    }
    const auto coding = request.header("transfer-encoding");
    if (coding && (*coding != "chunked" || count_fields(request, "transfer-encoding") > 1)) {
        return plain_problem(501, "the only transfer coding is chunked");
    }
    if (coding && version < 11) {
        return make_problem("malformed-request", "HTTP/1.0 has no transfer codings");
    }
    const auto length = request.header("content-length");
    if (count_fields(request, "content-length") > 1 ||
        (length && length->find_first_not_of("0123456789") != std::string::npos)) {
        return make_problem("malformed-request", "there must be one Content-Length");
    }
    const auto expectation = request.header("expect");
    if (expectation && *expectation != "100-continue" && *expectation != "100-Continue") {
        return plain_problem(417, "the only expectation is 100-continue");
    }
    return std::nullopt;
}

}  // namespace modelsynth::server
