#pragma once

#include "proto/problem.h"
#include "proto/timestamp.h"
#include "solver/core/observer.h"
#include "solver/registry/task.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

enum class JobState : std::uint8_t { kQueued, kRunning, kSucceeded, kFailed, kCancelled };

[[nodiscard]] std::string_view state_name(JobState state);
[[nodiscard]] std::optional<JobState> state_of(std::string_view name);
[[nodiscard]] bool is_ended(JobState state);

// A job as it is kept and shown.
struct Job {
    std::string id;
    JobState state = JobState::kQueued;
    std::string solver;
    std::uint64_t seed = 0;
    UnixMillis created = 0;
    std::optional<UnixMillis> started;
    std::optional<UnixMillis> finished;
    std::optional<UnixMillis> expires;
    std::uint32_t blocks_done = 0;
    std::uint32_t blocks_total = 0;
    std::string request;                          // JSON text, JobRequest::echo
    std::string result;                           // JSON text; empty: none
    std::string error;                            // JSON text; empty: none
    std::optional<std::uint64_t> queue_position;  // of queued jobs, 0 is next
    std::uint64_t head = 0;   // newest seq of its log at the time it was read, shown as `seq`
    std::string owner;        // name of the key that it was submitted with; not shown
    std::string traceparent;  // of the request it came with (W3C Trace Context); not shown
};

[[nodiscard]] std::string to_json(const Job& job);

// {"items": [...], "next": cursor or null}; the items are JSON texts.
[[nodiscard]] std::string list_json(
    const std::vector<std::string>& items, const std::optional<std::string>& next
);

// What a finished model is, for `result`.
struct JobResult {
    // Which of several, and its seed.
    struct Place {
        std::uint32_t alternative = 0;
        std::uint64_t seed = 0;
    };

    std::string job_id;
    std::uint64_t bytes = 0;
    std::string sha256;
    SynthesisStats stats;
    double solve_seconds = 0;
    GridSize size;
    bool has_cells = true;                      // its labels stand in the cells of a grid
    std::optional<Place> place = std::nullopt;  // nothing: the job has this one alone
};

[[nodiscard]] std::string to_json(const JobResult& result);

// The SHA-256 that a result tells, as hex.
// Requires: a JSON text as above.
[[nodiscard]] std::string result_digest(const std::string& result);

// `result` of a job with alternatives: the first one's, and the list of all.
// Requires: JSON texts as above, at least one, each with its place.
[[nodiscard]] std::string to_json(const std::vector<std::string>& alternatives);

// How many models a job was asked for and has, by its request and its result (JSON texts, may be
// empty): 1 unless it was asked for alternatives.
[[nodiscard]] std::uint32_t alternatives_of_request(const std::string& request);
[[nodiscard]] std::uint32_t alternatives_of_result(const std::string& result);

// A tally as text, for checkpoints, and back; nothing when the text is none.
[[nodiscard]] std::string encode_tally(const SearchTally& tally);
[[nodiscard]] std::optional<SearchTally> decode_tally(std::string_view text);

// --- events: the fields besides seq, type and time, as the JSON text of an object

[[nodiscard]] std::string queued_fields(std::uint64_t position);
// `warnings`: what of the request cannot be had, as far as it is known by then; the field is absent
// when there are none.
[[nodiscard]] std::string started_fields(
    std::uint32_t blocks_total, bool resumed, const std::vector<std::string>& warnings = {}
);
// `alternative`: of which of several models.
[[nodiscard]] std::string block_fields(
    const BlockReport& report, const std::optional<std::uint32_t>& alternative = std::nullopt
);

// What became of a candidate of a job with alternatives.
struct CandidateEnd {
    std::uint32_t candidate = 0;    // from 0
    std::uint32_t alternative = 0;  // the one that it was to be
    std::uint64_t seed = 0;
    std::string result;                 // JSON text of the new model; empty: it is none
    std::optional<std::uint32_t> same;  // the earlier alternative that it is equal to
    std::string error;                  // JSON text of a problem: there is no model
};

[[nodiscard]] std::string alternative_fields(const CandidateEnd& end);
// Nothing when the text is none.
[[nodiscard]] std::optional<CandidateEnd> parse_alternative_fields(std::string_view text);
[[nodiscard]] std::string succeeded_fields(const std::string& result_json);
[[nodiscard]] std::string failed_fields(const std::string& problem_json);
[[nodiscard]] std::string snapshot_fields(const std::string& job_json);

// An event as it is sent. Requires: `fields` is one of the texts above.
[[nodiscard]] std::string event_json(
    std::uint64_t seq, std::string_view type, UnixMillis time, std::string_view fields
);

// {"size": [x, y, z], "pieces": [...], "cells": [...]}
// Requires: a model on a grid.
[[nodiscard]] std::string labels_json(const Example& example, const Model& model);

// GET /v1/solvers and /v1/solvers/{name}; empty when there is no such solver.
[[nodiscard]] std::string solver_list_json();
[[nodiscard]] std::string solver_json(std::string_view name);

}  // namespace modelsynth::proto
