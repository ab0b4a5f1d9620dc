#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::cli {

// What the client makes use of in an event of a job's log; see API.md, "Events".
struct JobEvent {
    std::uint64_t seq = 0;
    std::string type;
    std::uint64_t blocks_done = 0;      // of block and snapshot
    std::uint64_t blocks_total = 0;     // of started, block and snapshot
    std::vector<std::string> warnings;  // of started
    bool is_accepted = false;           // of block
    std::uint64_t position = 0;         // of queued
    std::uint64_t accepted = 0;         // of succeeded: blocks, as the result counts them
    std::uint64_t reverted = 0;
    std::uint32_t models = 0;  // of succeeded: alternatives, or the one model
    std::string error;         // of failed: the problem document
    std::string text;          // the event as it came, on one line
};

// The event of a `data:` text; nothing when it is none.
[[nodiscard]] std::optional<JobEvent> parse_job_event(std::string_view text);

// How a job ended.
struct JobEnd {
    std::string state;         // succeeded, failed, cancelled
    std::string error;         // the problem document of a failed job
    std::uint32_t models = 0;  // of a job that succeeded
};

// The end of a job that the resource /v1/jobs/{id} shows; nothing while it is unfinished.
[[nodiscard]] std::optional<JobEnd> end_of_job(std::string_view job_json);

// The end of a job that its last event tells; nothing for any other event.
[[nodiscard]] std::optional<JobEnd> end_of_event(const JobEvent& event);

}  // namespace modelsynth::cli
