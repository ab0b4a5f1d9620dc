#pragma once

#include "clients/cli/failure.h"
#include "clients/cli/http_client.h"

#include <cstdint>
#include <optional>
#include <string>

namespace modelsynth::cli {

struct ListOptions {
    std::string state;  // empty: all
    std::uint64_t limit = 20;
};

// The short commands: one request, an answer shown as a table, or as JSON as it came.
[[nodiscard]] Outcome<void> list_jobs(
    const HttpClient& client, const ListOptions& options, bool as_json
);
[[nodiscard]] Outcome<void> list_examples(const HttpClient& client, bool as_json);
[[nodiscard]] Outcome<void> cancel_job(
    const HttpClient& client, const std::string& job_id, bool as_json
);
[[nodiscard]] Outcome<void> delete_job(
    const HttpClient& client, const std::string& job_id, bool as_json
);
// Prints the id that the example got. A name that ends in .glb is sent as a GLB, all else as JSON.
[[nodiscard]] Outcome<void> upload_example(
    const HttpClient& client, const std::string& path, bool as_json
);

}  // namespace modelsynth::cli
