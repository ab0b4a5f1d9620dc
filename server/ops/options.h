#pragma once

#include "server/ops/config.h"

#include <CLI/App.hpp>

#include <cstdint>
#include <string>

// The options of the command line by subject. Each has a name, limits and its default, which is
// what the configuration holds when it is declared.

namespace modelsynth::server {

// What stands in options as people write it, and in the configuration otherwise.
struct WrittenOptions {
    std::string listen = "127.0.0.1:8080";
    std::string log_format = "text";
    double retention_hours = 7 * 24;
    double forget_hours = 0;           // 0: four times the retention
    std::uint64_t data_bytes_max = 0;  // 0: no limit
    std::uint64_t drain_timeout_seconds = 30;
    std::uint64_t connections_per_address_max = 64;
};

void add_server_options(CLI::App& app, Config& config, WrittenOptions& written);
void add_work_options(CLI::App& app, Config& config);
void add_keeping_options(CLI::App& app, Config& config, WrittenOptions& written);
void add_http_options(CLI::App& app, Config& config, WrittenOptions& written);

}  // namespace modelsynth::server
