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

std::string to_rfc3339(UnixMillis time) {
    const auto seconds = time >= 0 ? time / 1000 : (time - 999) / 1000;
    return fmt::format(
        "{:%Y-%m-%dT%H:%M:%S}.{:03d}Z",
        fmt::gmtime(static_cast<std::time_t>(seconds)),
        time - seconds * 1000
    );
}

}  // namespace modelsynth::proto
