#pragma once

#include "proto/limits.h"
#include "proto/problem.h"
#include "solver/registry/task.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace modelsynth::proto {

// A job request, checked whole and with every default filled in.
struct JobRequest {
    std::string solver;
    std::string example_id;  // empty: the example came inline
    Task task;
    std::int32_t priority = 0;
    std::optional<double> deadline_seconds;
    // The request as JSON text with seed and defaults filled in: sent again it gives the same
    // model. This is what a job keeps and shows.
    std::string echo;
};

// The example of an id, or nothing.
using FindExample = std::function<std::optional<Example>(const std::string& id)>;

// Reads and checks a request. `seed_if_absent` is used when it names none.
// Fails: malformed-json, invalid-request with every fault, too-large.
[[nodiscard]] Parsed<JobRequest> parse_job_request(
    std::string_view body,
    const RequestLimits& limits,
    const FindExample& find_example,
    std::uint64_t seed_if_absent
);

// The text with keys sorted and white space removed, for telling equal requests apart from
// different ones. Fails: malformed-json.
[[nodiscard]] Parsed<std::string> canonical_json(std::string_view body, const JsonLimits& limits);

}  // namespace modelsynth::proto
