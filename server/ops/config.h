#pragma once

#include "server/http/server.h"
#include "server/jobs/job_service.h"

#include <tl/expected.hpp>

#include <string>

namespace modelsynth::server {

// Everything that can be set, with its default.
struct Config {
    std::string data_directory = "modelsynth-data";
    std::string log_level = "info";
    proto::UnixMillis retention_ms = proto::UnixMillis{7} * 24 * 3600 * 1000;
    JobServiceConfig jobs;
    HttpConfig http;
    AccessConfig access;
};

// The configuration of a command line. The error is the exit code to end with; what there is to
// say was printed.
[[nodiscard]] tl::expected<Config, int> parse_arguments(int argc, const char* const* argv);

}  // namespace modelsynth::server
