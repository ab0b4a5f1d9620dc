#pragma once

#include <cstdint>
#include <string>

namespace modelsynth::proto {

// Milliseconds since 1970-01-01T00:00:00Z, the form in which times are kept.
using UnixMillis = std::int64_t;

// The time now.
[[nodiscard]] UnixMillis now_millis();

// RFC 3339 in UTC with milliseconds: 2024-05-01T12:30:00.250Z.
[[nodiscard]] std::string to_rfc3339(UnixMillis time);

// As HTTP has dates (RFC 9110 5.6.7): Wed, 01 May 2024 12:30:00 GMT.
[[nodiscard]] std::string to_http_date(UnixMillis time);

}  // namespace modelsynth::proto
