#pragma once

#include "server/ops/config.h"

#include <CLI/App.hpp>

namespace modelsynth::server {

// The options of TLS and of webhooks.
void add_tls_options(CLI::App& app, Config& config);
void add_webhook_options(CLI::App& app, Config& config);

}  // namespace modelsynth::server
