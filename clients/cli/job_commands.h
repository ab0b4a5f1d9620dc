#pragma once

#include "clients/cli/failure.h"
#include "clients/cli/http_client.h"
#include "clients/cli/run_options.h"

#include <cstdint>
#include <optional>
#include <string>

namespace modelsynth::cli {

struct SubmitOptions {
    RequestOptions request;
    std::string idempotency_key;
    bool is_followed = false;
    std::string output;  // empty: the model is not fetched
    ModelForm form;
};

struct FollowOptions {
    std::string job_id;
    std::uint64_t after = 0;
};

struct FetchOptions {
    std::string job_id;
    std::string output;
    ModelForm form;
    bool is_preview = false;
    bool is_labels = false;
    std::optional<std::uint64_t> alternative = {};
};

// The commands about one job and its model. They print what they were asked for on standard
// output, progress and summaries on standard error.
[[nodiscard]] Outcome<void> submit(
    const HttpClient& client, const SubmitOptions& options, bool as_json
);
[[nodiscard]] Outcome<void> follow(
    const HttpClient& client, const FollowOptions& options, bool as_json
);
[[nodiscard]] Outcome<void> fetch(
    const HttpClient& client, const FetchOptions& options, bool as_json
);
// Submits, follows and fetches.
[[nodiscard]] Outcome<void> run_on_server(
    const HttpClient& client, const RunOptions& options, bool as_json
);

}  // namespace modelsynth::cli
