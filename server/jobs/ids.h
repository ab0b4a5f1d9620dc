#pragma once

#include "proto/timestamp.h"

#include <cstdint>
#include <string>

namespace modelsynth::server {

// A new job id: 26 characters, safe in a path, sorting by time of creation, unguessable enough
// not to be met by chance. Thread-safe.
[[nodiscard]] std::string make_job_id(proto::UnixMillis now);

// A seed for a request that names none: 0 ... 2^53-1.
[[nodiscard]] std::uint64_t make_seed();

}  // namespace modelsynth::server
