#include "proto/timestamp.h"

#include <fmt/chrono.h>

#include <chrono>

namespace modelsynth::proto {

UnixMillis now_millis() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch()
    )
        .count();
}

namespace {

// Rounded down, before 1970 too.
std::time_t seconds_of(UnixMillis time) { return time >= 0 ? time / 1000 : (time - 999) / 1000; }

}  // namespace

std::string to_rfc3339(UnixMillis time) {
    const std::time_t seconds = seconds_of(time);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(seconds), time - seconds * 1000);
}

// The program never sets a locale, so names are the English ones.
std::string to_http_date(UnixMillis time) {
    return fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(seconds_of(time)));
}

}  // namespace modelsynth::proto
