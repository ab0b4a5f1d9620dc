#pragma once

#include "server/ops/config.h"

#include <string>

namespace modelsynth::server {

// The resource /v1/limits: what a client can hit, and how long things are kept, under this
// configuration.
[[nodiscard]] std::string limits_document(const Config& config);

}  // namespace modelsynth::server
