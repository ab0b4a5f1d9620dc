#pragma once

#include "server/jobs/job_service.h"
#include "server/store/types.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace modelsynth::server {

// A client that needed this long for one write does not keep up ...
inline constexpr auto kSlowWrite = std::chrono::seconds(2);
// ... and is then spared the events in between when there are more than this.
inline constexpr std::uint64_t kLagMax = 64;

// For a reader that lags: one `snapshot` event in place of those after `position`; nothing when
// they are few. Never in place of the last event: of an ended job it shows the state before the
// end. Blocks.
[[nodiscard]] std::optional<Event> snapshot_after(
    JobService& service, const std::string& job_id, std::uint64_t position
);

}  // namespace modelsynth::server
