#pragma once

#include "server/http/server.h"
#include "server/jobs/job_service.h"
#include "server/ops/logging.h"
#include "server/webhooks/webhook_config.h"

#include <tl/expected.hpp>

#include <chrono>
#include <cstdint>
#include <string>

namespace modelsynth::server {

// Everything that can be set, with its default.
struct Config {
    std::string data_directory = "modelsynth-data";
    proto::UnixMillis retention_ms = proto::UnixMillis{7} * 24 * 3600 * 1000;
    std::chrono::seconds drain_timeout{30};
    LogConfig log;
    JobServiceConfig jobs;
    HttpConfig http;
    AccessConfig access;
    WebhookConfig webhooks;
};

// The name of the program's version.
[[nodiscard]] const char* version();

// The configuration of a command line, the environment (--queue-max is MODELSYNTH_QUEUE_MAX) and
// the file that --config names, of which the earlier wins. The error is the exit code to end with;
// what there is to say was printed: every fault with its place and 2, or what was asked for and 0.
[[nodiscard]] tl::expected<Config, int> parse_arguments(int argc, const char* const* argv);

}  // namespace modelsynth::server
