#pragma once

#include "server/http/message.h"

#include <spdlog/logger.h>

#include <functional>

namespace modelsynth::server {

// What `answer` gives. When it throws, which is a fault of ours: an answer of 500 that says so, and
// a line in the log, so that a fault costs the request that met it and no other.
[[nodiscard]] Response answer_or_excuse(
    const Request& request, spdlog::logger& log, const std::function<Response()>& answer
);

}  // namespace modelsynth::server
