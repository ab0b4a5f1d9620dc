#include "proto/timestamp.h"

#include <fmt/chrono.h>

#include <chrono>

namespace modelsynth::proto {

std::string to_rfc3339(UnixMillis time) {
    const auto seconds = time >= 0 ? time / 1000 : (time - 999) / 1000;
    return fmt::format(
        "{:%Y-%m-%dT%H:%M:%S}.{:03d}Z",
        fmt::gmtime(static_cast<std::time_t>(seconds)),
        time - seconds * 1000
    );
}

}  // namespace modelsynth::proto
