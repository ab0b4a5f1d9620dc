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

// The finished job that another one starts from.
struct JobOrigin {
    std::string job_id;
    std::uint32_t alternative = 0;  // which of its models
    // Without its labels: they are not on the wire; whoever runs the job puts them there.
    Origin origin = {};
};

// A job request, checked whole and with every default filled in.
struct JobRequest {
    std::string solver;
    std::string example_id;  // empty: the example came inline
    Task task;               // without its origin
    std::optional<JobOrigin> from;
    std::int32_t priority = 0;
    std::optional<double> deadline_seconds;
    std::optional<std::uint32_t> alternatives;  // so many different models, as a list
    std::string webhook;                        // URL that is told of the job's end; empty: none
    // The request as JSON text with seed and defaults filled in: sent again it gives the same
    // model. This is what a job keeps and shows.
    std::string echo;
};

// The example of an id, or nothing.
using FindExample = std::function<std::optional<Example>(const std::string& id)>;

// The request of a finished job, for one that starts from it: solver, example and parameters are
// taken from there, field by field, unless they are given. Fails: not-found when there is no such
// job or it has no such model, which is a fault of the request; else with the problem that the
// request is answered with.
using FindOrigin =
    std::function<Parsed<JobRequest>(const std::string& job_id, std::uint32_t alternative)>;

// What is wrong with the URL of a webhook, or nothing.
using CheckWebhook = std::function<std::optional<std::string>(const std::string& url)>;

// Reads and checks a request. `seed_if_absent` is used when it names none. Without `find_origin`
// it is an echo, which tells all that it needs of the job that it starts from. Without
// `check_webhook` a request, but for an echo, may have none.
// Fails: malformed-json, invalid-request with every fault, too-large; when nothing else is wrong,
//        as find_origin.
[[nodiscard]] Parsed<JobRequest> parse_job_request(
    std::string_view body,
    const RequestLimits& limits,
    const FindExample& find_example,
    const FindOrigin& find_origin,
    std::uint64_t seed_if_absent,
    const CheckWebhook& check_webhook = nullptr
);

// The text with keys sorted and white space removed, for telling equal requests apart from
// different ones. Fails: malformed-json.
[[nodiscard]] Parsed<std::string> canonical_json(std::string_view body, const JsonLimits& limits);

}  // namespace modelsynth::proto
