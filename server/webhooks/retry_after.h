#pragma once

#include "proto/timestamp.h"

#include <optional>
#include <string_view>

namespace modelsynth::server {

// How long the receiver asks us to wait, in milliseconds: what a field Retry-After says at `now`,
// as whole seconds or as a date in one of HTTP's three forms (RFC 9110, sections 10.2.3 and 5.6.7);
// 0 when the date is past. Seconds that no number holds are the most that one does. Nothing when
// it is neither.
[[nodiscard]] std::optional<proto::UnixMillis> parse_retry_after(
    std::string_view field, proto::UnixMillis now
);

}  // namespace modelsynth::server
