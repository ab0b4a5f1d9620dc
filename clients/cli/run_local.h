#pragma once

#include "clients/cli/failure.h"
#include "clients/cli/run_options.h"

namespace modelsynth::cli {

// Says which solver the request is for where it names a built-in example and no solver.
void complete_request(RequestOptions& request);

// `modelsynth run --local`: checks the request as the server does, solves it in this process and
// writes the bytes that the server would serve. Only the built-in examples have ids here.
// Fails: as the server's answer or the failed job would; kInterrupted, leaving no file.
[[nodiscard]] Outcome<void> run_local(const RunOptions& options, bool as_json);

}  // namespace modelsynth::cli
