// Every text and frame that clients read, so that none changes by accident.

#include "proto/example_codec.h"
#include "proto/frame.h"
#include "proto/job.h"
#include "proto/job_request.h"
#include "proto/problem.h"
#include "tests/golden/golden.h"

#include <gtest/gtest.h>

#include <string>

namespace modelsynth::proto {
namespace {

using testing::expect_golden;

constexpr const char* kLine = R"({
  "kind": "discrete", "name": "line", "cell": [1, 2, 1.5],
  "pieces": [ { "name": "empty" }, { "name": "ground" },
              { "name": "wall", "weight": 2 }, { "name": "gate", "turns": 3 } ],
  "size": [4, 2, 3], "cells": [ 1,1,1,1, 1,1,1,1, 1,1,1,1,  0,2,3,2, 0,2,0,0, 0,0,0,0 ],
  "empty": "empty", "boundary": { "bottom": "example", "top": "empty" }
})";

Example line() { return parse_example(kLine, {})->example; }

JobRequest request() {
    const std::string body = R"({"solver": "discrete", "example": "line", "seed": 4711,
        "parameters": {"size": [12, 2, 9], "weights": {"wall": 0.5}, "order": "min_entropy",
                       "boundary": {"east": "wall", "north": ["wall", "gate", "ground"]},
                       "blocks": {"size": [6, 2, 6], "overlap": 0.25, "attempts": 3},
                       "constraints": [{"kind": "fixed", "pieces": ["gate"], "cells": [[3, 1, 0]]}]},
        "priority": 2, "deadline": 30, "tags": {"level": "seven"}})";
    auto parsed = parse_job_request(
        body, {}, [](const std::string&) { return std::optional(line()); }, nullptr, 0
    );
    return parsed.value();  // throws when it could not be read
}

Job queued_job() {
    Job job;
    job.id = "01hx0000000000000000000000";
    job.solver = "discrete";
    job.seed = 4711;
    job.created = 1714566600250;
    job.request = request().echo;
    job.queue_position = 3;
    job.head = 1;
    return job;
}

TEST(Golden, Jobs) {
    std::string text = queued_job().request + "\n" + to_json(queued_job()) + "\n";
    Job job = queued_job();
    job.queue_position.reset();
    job.state = JobState::kRunning;
    job.started = job.created + 40;
    job.blocks_done = 3;
    job.blocks_total = 8;
    job.head = 5;
    text += to_json(job) + "\n";
    job.state = JobState::kSucceeded;
    job.finished = job.created + 1234;
    job.expires = job.created + 86'400'000;
    job.blocks_done = 8;
    job.head = 11;
    job.result = to_json(JobResult{
        job.id,
        123456,
        std::string(64, 'a'),
        {{{5, 1, 1, 0}, 1, 40}, 0.8125},
        0.0123456,
        {12, 2, 9}});
    text += to_json(job) + "\n";
    job.state = JobState::kFailed;
    job.result.clear();
    job.error = to_json(make_problem("deadline-exceeded", "the job was solving for too long"));
    text += to_json(job) + "\n";
    job.state = JobState::kCancelled;
    job.error.clear();
    text += to_json(job) + "\n";
    text += list_json({"{}", "{}"}, "cursor") + "\n" + list_json({}, std::nullopt) + "\n";
    expect_golden("jobs.txt", text);
}

TEST(Golden, Events) {
    const Problem problem = make_problem("gave-up", "no model was found");
    const BlockReport accepted = {2, 8, {{0, 0, 3}, {6, 2, 9}}, true, 1, {}, {}};
    const BlockReport reverted = {7, 8, {{6, 0, 3}, {12, 2, 9}}, false, 3, {}, {}};
    const UnixMillis time = 1714566600250;
    std::string text;
    text += event_json(1, "queued", time, queued_fields(3)) + "\n";
    text += event_json(2, "started", time + 1, started_fields(8, false)) + "\n";
    text += event_json(3, "block", time + 2, block_fields(accepted)) + "\n";
    text += event_json(4, "started", time + 3, started_fields(8, true, {"one", "two"})) + "\n";
    text += event_json(5, "block", time + 4, block_fields(reverted)) + "\n";
    text += event_json(6, "succeeded", time + 5, succeeded_fields(R"({"bytes":1})")) + "\n";
    text += event_json(6, "failed", time + 6, failed_fields(to_json(problem))) + "\n";
    text += event_json(6, "cancelled", time + 7, "{}") + "\n";
    text += event_json(6, "snapshot", time + 8, snapshot_fields(to_json(queued_job()))) + "\n";
    text += event_json(7, "block", time + 9, block_fields(accepted, 1)) + "\n";
    const std::string result = to_json(JobResult{
        "x", 123, std::string(64, 'b'), {{{1}, 0, 0}, 0.5}, 0.5, {1, 2, 3}, true, {{1, 99}}});
    text += event_json(8, "alternative", time + 10, alternative_fields({2, 1, 99, result, {}, {}}));
    text += "\n";
    text +=
        event_json(9, "alternative", time + 11, alternative_fields({3, 2, 98, {}, 1, {}})) + "\n";
    text += event_json(
        10, "alternative", time + 12, alternative_fields({4, 2, 97, {}, {}, to_json(problem)})
    );
    text += "\n";
    text += event_json(11, "succeeded", time + 13, succeeded_fields(to_json(std::vector{result})));
    text += "\n";
    expect_golden("events.txt", text);
}

TEST(Golden, Problems) {
    std::string text;
    for (const ProblemKind& kind : problem_kinds()) {
        Problem problem = make_problem(kind.name, "what happened");
        problem.instance = "/v1/jobs/x";
        problem.errors = {{"/parameters/size/0", "must be \"positive\""}};
        text += to_json(problem) + "\n";
    }
    expect_golden("problems.txt", text);
}

TEST(Golden, ExamplesAndSolvers) {
    const auto upload = parse_example(kLine, {});
    ASSERT_TRUE(upload);
    discrete::Parameters parameters;
    parameters.size = {2, 2, 1};
    Preparations preparations;
    const Model model = {
        space_of(upload->example, parameters, preparations).value(), {1, 2, 0, kNoLabel}};
    expect_golden(
        "examples.txt",
        upload->canonical + "\n" + example_summary(upload->example, "line-1", false) + "\n" +
            example_resource(upload->example, "line-1", false) + "\n" +
            labels_json(upload->example, model) + "\n" + solver_list_json() + "\n" +
            solver_json("discrete") + "\n" + solver_json("continuous") + "\n"
    );
}

TEST(Golden, Frames) {
    std::string text;
    for (const FrameKind kind :
         {FrameKind::kLabels, FrameKind::kLabelsWhole, FrameKind::kGlb, FrameKind::kGlbWhole}) {
        const std::string bytes = encode_frame(
            {kind,
             0x0102030405,
             {{-1, 0, 3}, {6, 2, 900}},
             encode_labels(std::vector<Label>{0, 258, kNoLabel})}
        );
        static constexpr const char* kHex = "0123456789abcdef";
        for (const char c : bytes) {
            text += kHex[static_cast<unsigned char>(c) >> 4];
            text += kHex[static_cast<unsigned char>(c) & 15];
        }
        text += "\n";
    }
    expect_golden("frames.txt", text);
}

}  // namespace
}  // namespace modelsynth::proto
