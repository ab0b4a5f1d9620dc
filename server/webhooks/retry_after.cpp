#include "server/webhooks/retry_after.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <ctime>
#include <limits>
#include <string>
#include <system_error>

namespace modelsynth::server {

using proto::UnixMillis;

namespace {

constexpr UnixMillis kSecondsMax = std::numeric_limits<UnixMillis>::max() / 1000;

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Seconds of the Unix epoch. The program never sets a locale, so names are the English ones.
std::optional<UnixMillis> parse_date(const std::string& text) {
    for (const char* form :
         {"%a, %d %b %Y %H:%M:%S GMT", "%A, %d-%b-%y %H:%M:%S GMT", "%a %b %e %H:%M:%S %Y"}) {
        std::tm date = {};
        const char* end = ::strptime(text.c_str(), form, &date);
        if (end != nullptr && *end == '\0') {
            return ::timegm(&date);
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<UnixMillis> parse_retry_after(std::string_view field, UnixMillis now) {
    if (is_digits(field)) {
        UnixMillis seconds = 0;
        const auto read = std::from_chars(field.data(), field.data() + field.size(), seconds);
        const bool is_held = read.ec == std::errc() && seconds < kSecondsMax;
        return (is_held ? seconds : kSecondsMax) * 1000;
    }
    const auto date = parse_date(std::string(field));
    if (!date) {
        return std::nullopt;
    }
    return std::max<UnixMillis>(0, *date * 1000 - now);
}

}  // namespace modelsynth::server
