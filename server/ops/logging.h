#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>

namespace modelsynth::server {

// A logger to standard error: one line an event, constant text and then key=value.
[[nodiscard]] std::shared_ptr<spdlog::logger> make_logger(const std::string& level);

}  // namespace modelsynth::server
