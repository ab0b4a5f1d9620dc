#pragma once

#include "proto/problem.h"
#include "server/store/types.h"

namespace modelsynth::server {

// What a failure of the store means to a client.
[[nodiscard]] proto::Problem problem_of(const StoreError& error);

}  // namespace modelsynth::server
