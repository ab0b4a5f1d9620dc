#include "server/http/correlation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string_view>

namespace modelsynth::server {

namespace {

bool is_request_id(std::string_view text) {
    return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '.' || c == '_' || c == '-';
    });
}

bool is_hex(std::string_view text) {
    return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_zero(std::string_view text) {
    return text.find_first_not_of('0') == std::string_view::npos;
}

// version "-" trace-id "-" parent-id "-" flags; a later version may have more after a further "-".
constexpr std::size_t kTraceparentBytes = 55;

bool is_traceparent(std::string_view text) {
    if (text.size() < kTraceparentBytes || text[2] != '-' || text[35] != '-' || text[52] != '-') {
        return false;
    }
    const std::string_view version = text.substr(0, 2);
    const std::string_view trace = text.substr(3, 32);
    const std::string_view parent = text.substr(36, 16);
    const bool has_right_end =
        text.size() == kTraceparentBytes || (version != "00" && text[kTraceparentBytes] == '-');
    return is_hex(version) && version != "ff" && is_hex(trace) && !is_zero(trace) &&
           is_hex(parent) && !is_zero(parent) && is_hex(text.substr(53, 2)) && has_right_end;
}

}  // namespace

std::string make_request_id() {
    // Told apart by chance; nothing is secret about it.
    thread_local std::mt19937_64 generator = [] {
        std::random_device device;
        std::seed_seq seed = {device(), device(), device(), device()};
        return std::mt19937_64(seed);
    }();
    return fmt::format("{:016x}", std::uint64_t{generator()});
}

void take_correlation(Request& request) {
    if (const auto id = request.header("x-request-id"); id && is_request_id(*id)) {
        request.id = *id;
    }
    // Two of them make a list, which is no traceparent.
    const auto parent = request.header_list("traceparent");
    if (parent && is_traceparent(*parent)) {
        request.traceparent = parent->substr(0, kTraceparentBytes);
    }
}

}  // namespace modelsynth::server
