#include "server/http/request_fields.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace modelsynth::server {

using proto::make_problem;
using proto::Parsed;

std::optional<std::uint64_t> parse_number(const std::string& text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    if (text.empty() || parsed.ec != std::errc() || parsed.ptr != end) {
        return std::nullopt;
    }
    return value;
}

bool is_whole_number(std::string_view text) {
    text.remove_prefix(text.starts_with('-') ? 1 : 0);
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::optional<std::string> media_type(const Request& request) {
    const auto type = request.header("content-type");
    if (!type) {
        return std::nullopt;
    }
    std::string media = type->substr(0, type->find(';'));
    media.erase(std::remove(media.begin(), media.end(), ' '), media.end());
    return lower_case(std::move(media));
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    });
    return text;
}

std::vector<std::string> list_items(const std::string& list, Quoted wanted) {
    std::vector<std::string> items(1);
    bool quoted = false;
    for (const char c : list) {
        if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && c == ',') {
            items.emplace_back();
        } else if (quoted ? wanted == Quoted::kKept : c != ' ' && c != '\t') {
            items.back() += c;
        }
    }
    return items;
}

std::optional<std::uint64_t> preferred_wait(const Request& request) {
    // A value is a word or a string (RFC 7240 2).
    const std::string list = request.header_list("prefer").value_or("");
    for (const std::string& part : list_items(list, Quoted::kKept)) {
        const std::string preference = lower_case(part.substr(0, part.find(';')));
        if (!preference.starts_with("wait=")) {
            continue;
        }
        const std::string digits = preference.substr(5);
        if (!digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos) {
            return std::min(kWaitSecondsMax, parse_number(digits).value_or(kWaitSecondsMax));
        }
    }
    return std::nullopt;
}

namespace {

// The quality of an item of an Accept list (RFC 9110 12.4.2); what is malformed counts as 1.
double quality_of(const std::string& item) {
    const std::size_t at = item.find(";q=");
    double quality = 1;
    if (at != std::string::npos) {
        const char* end = item.data() + item.size();
        std::from_chars(item.data() + at + 3, end, quality);
    }
    return quality;
}

}  // namespace

bool wants_event_stream(const Request& request) {
    std::string wanted;
    double best = 0;
    for (const std::string& part : list_items(request.header_list("accept").value_or(""))) {
        const std::string item = lower_case(part);
        const std::string type = item.substr(0, item.find(';'));
        const bool is_offered = type == "text/event-stream" || type == "application/json";
        if (is_offered && quality_of(item) > best) {
            wanted = type;
            best = quality_of(item);
        }
    }
    return wanted == "text/event-stream";
}

Parsed<std::string> idempotency_key(const Request& request) {
    std::string key = request.header("idempotency-key").value_or("");
    if (key.size() >= 2 && key.front() == '"' && key.back() == '"') {
        key = key.substr(1, key.size() - 2);
    }
    const bool printable =
        std::all_of(key.begin(), key.end(), [](char c) { return c > 0x20 && c < 0x7F; });
    if (key.size() > kIdempotencyKeyCharactersMax || !printable ||
        (key.empty() && request.header("idempotency-key").has_value())) {
        return tl::unexpected(make_problem(
            "malformed-request",
            "an Idempotency-Key has 1 to " + std::to_string(kIdempotencyKeyCharactersMax) +
                " visible ASCII characters"
        ));
    }
    return key;
}

}  // namespace modelsynth::server
