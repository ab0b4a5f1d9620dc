#include "proto/example_codec.h"
#include "proto/frame.h"
#include "proto/job.h"
#include "proto/job_request.h"
#include "proto/problem.h"
#include "proto/timestamp.h"
#include "solver/discrete/explanation/contradiction.h"
#include "solver/examples/built_in.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace modelsynth::proto {
namespace {

constexpr const char* kLine = R"({
  "kind": "discrete", "name": "line", "cell": [1, 1, 1],
  "pieces": [ { "name": "empty" }, { "name": "ground" }, { "name": "wall", "weight": 2 } ],
  "size": [4, 2, 3], "cells": [ 1,1,1,1, 1,1,1,1, 1,1,1,1,  0,2,0,0, 0,2,0,0, 0,0,0,0 ],
  "empty": "empty",
  "boundary": { "bottom": "example", "top": "empty" }
})";

std::optional<Example> find_built_in(const std::string& id) {
    for (const auto& example : examples::built_in()) {
        if (example->name == id) {
            return example;
        }
    }
    return std::nullopt;
}

Parsed<JobRequest> parse(const std::string& body) {
    return parse_job_request(body, {}, find_built_in, nullptr, 11);
}

std::vector<std::string> pointers(const Problem& problem) {
    std::vector<std::string> found;
    for (const Fault& fault : problem.errors) {
        found.push_back(fault.pointer);
    }
    return found;
}

TEST(JobRequest, NeedsOnlySolverAndExample) {
    const auto request = parse(R"({"solver": "discrete", "example": "castle"})");
    ASSERT_TRUE(request) << to_json(request.error());
    EXPECT_EQ(request->task.seed, 11U);
    EXPECT_EQ(model_size(request->task.parameters), (GridSize{40, 10, 40}));
}

TEST(JobRequest, ItsEchoGivesTheSameRequestAgain) {
    const auto first = parse(R"({"solver": "discrete", "example": "city", "priority": -3,
        "parameters": {"size": [20, 10, 21], "order": "random", "weights": {"air": 2.5},
        "boundary": {"top": "air", "north": "free"}, "blocks": {"overlap": 0.25},
        "constraints": [{"kind": "fixed", "pieces": ["air"], "cells": [[1, 9, 1]]}]},
        "deadline": 2.5, "tags": {"level": "3"}})");
    ASSERT_TRUE(first) << to_json(first.error());
    const auto second = parse(first->echo);
    ASSERT_TRUE(second) << to_json(second.error());
    EXPECT_EQ(first->echo, second->echo);
}

TEST(JobRequest, FindsEveryFaultAtOnce) {
    const auto request = parse(R"({"solver": "x", "example": "castle", "seed": 9007199254740992,
        "parameters": {"size": [0, 8.5, "a"], "no": 1, "order": "up",
        "boundary": {"top": 3, "left": "air"}}, "priority": 11, "tags": {"a/b": 1}})");
    ASSERT_FALSE(request);
    EXPECT_EQ(request.error().type, "/problems/invalid-request");
    EXPECT_EQ(
        pointers(request.error()),
        (std::vector<std::string>{
            "/solver",
            "/seed",
            "/parameters/size/0",
            "/parameters/size/1",
            "/parameters/size/2",
            "/parameters/boundary/top",
            "/parameters/boundary/left",
            "/parameters/order",
            "/parameters/no",
            "/priority",
            "/tags/a~1b"})
    );
}

TEST(JobRequest, WholeNumbersMayBeWrittenWithAPointAndNothingIsRounded) {
    EXPECT_TRUE(parse(R"({"solver": "discrete", "example": "castle", "seed": 7.0})"));
    for (const char* seed : {"7.5", "-1", "true", "\"7\"", "1e300", "9007199254740992", "null"}) {
        EXPECT_FALSE(parse(
            std::string(R"({"solver": "discrete", "example": "castle", "seed": )") + seed + "}"
        )) << seed;
    }
}

TEST(JobRequest, LimitsHoldAtTheirEdge) {
    const auto sized = [](const std::string& size) {
        return parse(
            R"({"solver": "discrete", "example": "castle", "parameters": {"size": )" + size + "}}"
        );
    };
    EXPECT_TRUE(sized("[4096, 1, 976]"));
    const auto large = sized("[4096, 1, 977]");  // 4 001 792 cells
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().type, "/problems/too-large");
    EXPECT_EQ(pointers(large.error()), std::vector<std::string>{"/parameters/size"});
    EXPECT_FALSE(sized("[4097, 1, 1]"));
}

TEST(JobRequest, AlternativesHaveTheLimitsOfOneModelTogether) {
    const auto request = [](const std::string& alternatives, const std::string& parameters) {
        return parse(
            R"({"solver": "discrete", "example": "castle", "alternatives": )" + alternatives +
            R"(, "parameters": )" + parameters + "}"
        );
    };
    const auto fault = [&](const std::string& alternatives, const std::string& parameters) {
        const auto refused = request(alternatives, parameters);
        return refused ? std::string("accepted")
                       : refused.error().type + " " + refused.error().errors.front().pointer;
    };
    const std::string cells = R"({"size": [250, 10, 250]})";  // 625 000
    EXPECT_EQ(request("6", cells)->alternatives, 6U);
    EXPECT_EQ(fault("7", cells), "/problems/too-large /alternatives");
    const std::string blocks =  // 10 000 in each
        R"({"size": [200, 2, 200], "blocks": {"size": [2, 2, 2], "overlap": 0}})";
    EXPECT_EQ(request("20", blocks)->alternatives, 20U);
    EXPECT_EQ(fault("21", blocks), "/problems/too-large /alternatives");
    const std::string small = R"({"size": [10, 8, 10]})";
    EXPECT_EQ(request("64", small)->alternatives, 64U);
    for (const char* bad : {"0", "65", "-1", "1.5", "null", "\"3\""}) {
        EXPECT_EQ(fault(bad, small), "/problems/invalid-request /alternatives") << bad;
    }
}

TEST(JobEvents, WhatBecameOfACandidateIsReadAsItWasWritten) {
    const auto round = [](const CandidateEnd& end) {
        return parse_alternative_fields(alternative_fields(end)).value_or(CandidateEnd{});
    };
    const CandidateEnd made = round({3, 2, 17, R"({"sha256":"ab"})", {}, {}});
    EXPECT_EQ(made.candidate, 3U);
    EXPECT_EQ(made.alternative, 2U);
    EXPECT_EQ(made.seed, 17U);
    EXPECT_EQ(made.result, R"({"sha256":"ab"})");
    EXPECT_EQ(result_digest(made.result), "ab");
    EXPECT_EQ(round({3, 2, 17, {}, 1, {}}).same, 1U);
    EXPECT_EQ(round({3, 2, 17, {}, {}, R"({"status":500})"}).error, R"({"status":500})");
    for (const char* none :
         {"",
          "7",
          "[]",
          "{}",
          R"({"alternative":0,"candidate":0,"seed":1})",
          R"({"alternative":0,"candidate":0,"seed":1,"result":3})",
          R"({"alternative":0,"candidate":0,"seed":-1,"same_as":0})",
          R"({"alternative":0,"candidate":0,"seed":1,"same_as":0,"result":{}})"}) {
        EXPECT_FALSE(parse_alternative_fields(none)) << none;
    }
}

TEST(Json, RefusesDepthDuplicatesAndTextAfterANul) {
    EXPECT_EQ(parse(std::string(100'000, '[')).error().type, "/problems/malformed-json");
    EXPECT_EQ(
        parse(R"({"solver": "discrete", "solver": "discrete"})").error().type,
        "/problems/malformed-json"
    );
    EXPECT_EQ(parse(std::string("{}") + '\0' + "x").error().type, "/problems/malformed-json");
    const auto broken = parse(R"({"solver": })");
    ASSERT_FALSE(broken);
    EXPECT_NE(broken.error().detail.find("at byte 11"), std::string::npos) << broken.error().detail;
}

TEST(ExampleCodec, ReadsTheContractsExample) {
    const auto upload = parse_example(kLine, {});
    ASSERT_TRUE(upload) << to_json(upload.error());
    const auto& example = *std::get<std::shared_ptr<const discrete::Example>>(upload->example);
    EXPECT_EQ(example.pieces.size(), 3U);
    EXPECT_EQ(example.pieces[2].weight, 2);
    EXPECT_EQ(example.empty, Label{0});
    EXPECT_FALSE(example.pieces[0].mesh);  // drawn as nothing
    EXPECT_TRUE(example.pieces[1].mesh);   // a box of its own
    EXPECT_EQ(parse_example(upload->canonical, {})->canonical, upload->canonical);
}

TEST(ExampleCodec, NamesWhatIsWrong) {
    const auto upload = parse_example(
        R"({"kind": "discrete", "name": "n", "pieces": [{"name": "a"}, {"name": "a"}, {}],
            "size": [2, 1, 1], "cells": [0, 3], "empty": "x",
            "boundary": {"east": "periodic", "top": ["a", "y"]}})",
        {}
    );
    ASSERT_FALSE(upload);
    EXPECT_EQ(
        pointers(upload.error()),
        (std::vector<std::string>{
            "/pieces/1/name",
            "/pieces/2/name",
            "/cells/1",
            "/empty",
            "/boundary/top/1",
            "/boundary/east"})
    );
}

TEST(Frame, SurvivesTheWireAndRefusesWhatIsNotWhole) {
    const Frame frame = {
        FrameKind::kLabels,
        0x1122334455667788,
        {{-1, 2, 3}, {4, 5, 600}},
        encode_labels(std::vector<Label>{1, 513, kNoLabel})};
    const std::string bytes = encode_frame(frame);
    ASSERT_EQ(bytes.size(), kFrameHeaderBytes + 6);
    EXPECT_EQ(bytes.substr(0, 6), std::string("MSYF\x01\x01"));
    const auto decoded = decode_frame(bytes);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->seq, frame.seq);
    EXPECT_EQ(decoded->region, frame.region);
    EXPECT_EQ(decode_labels(decoded->payload), (std::vector<Label>{1, 513, kNoLabel}));
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        EXPECT_FALSE(decode_frame(bytes.substr(0, length)));
    }
    EXPECT_FALSE(decode_frame(bytes + "x"));
}

TEST(Events, AreAsTheContractWritesThem) {
    EXPECT_EQ(
        event_json(3, "block", 1714566600250, R"({"index":0})"),
        R"({"seq":3,"type":"block","time":"2024-05-01T12:30:00.250Z","index":0})"
    );
    EXPECT_EQ(
        event_json(4, "cancelled", 0, "{}"),
        R"({"seq":4,"type":"cancelled","time":"1970-01-01T00:00:00.000Z"})"
    );
    EXPECT_EQ(
        block_fields({11, 49, {{0, 0, 5}, {10, 10, 15}}, true, 2, {}, {}}),
        R"({"index":11,"region":{"min":[0,0,5],"max":[10,10,15]},"outcome":"accepted",)"
        R"("attempts":2,"blocks_done":12,"blocks_total":49,"fraction":0.244898})"
    );
    EXPECT_EQ(to_rfc3339(-1), "1969-12-31T23:59:59.999Z");
}

TEST(Problems, AreAsTheStandardWritesThem) {
    Problem problem = make_problem("invalid-request", "no\xFF");
    problem.errors = {{"/a", "b"}};
    EXPECT_EQ(
        to_json(problem),
        "{\"type\":\"/problems/invalid-request\",\"title\":\"The request cannot be done\","
        "\"status\":422,\"detail\":\"no\xEF\xBF\xBD\",\"errors\":[{\"pointer\":\"/a\","
        "\"detail\":\"b\"}]}"
    );
}

TEST(Tally, ComesBackFromItsTextAndNothingElseDoes) {
    const SearchTally tally = {{7, 0, 4'294'967'295, 2}, 3, 1, 1'000'000'000'000};
    EXPECT_EQ(encode_tally(tally), "[7,0,4294967295,2,0,0,0,3,1,1000000000000]");
    EXPECT_EQ(decode_tally(encode_tally(tally)), tally);
    EXPECT_EQ(decode_tally("[0,0,0,0,0,0,0,0,0,0]"), SearchTally());
    for (const char* text :
         {"",
          "[",
          "{}",
          "7",
          "[7,0,0,2,3,4,5,6,7]",
          "[7,0,0,2,3,4,5,6,7,8,9]",
          "[7,0,-1,2,3,4,5,6,7,8]",
          "[4294967296,0,0,0,0,0,0,0,0,0]",
          "[0,0,0,0,0,0,0,4294967296,0,0]",
          "[0,0,0,0,0,0,0,0,4294967296,0]",
          "[1.5,0,0,0,0,0,0,0,0,0]",
          "[\"1\",0,0,0,0,0,0,0,0,0]"}) {
        EXPECT_FALSE(decode_tally(text)) << text;
    }
}

discrete::Contradiction conflict_at_a_cell_of(std::size_t labels) {
    discrete::Contradiction conflict;
    conflict.sides = {"bottom"};
    conflict.constraints = {{2, "count"}};
    conflict.cells = {{{1, 2, 3}, std::vector<std::string>(labels, "a")}};
    conflict.is_minimal = true;
    return conflict;
}

TEST(Explanation, OfAContradictionBecomesItsConflict) {
    Error error = {ErrorCode::kContradiction, "why", {}, conflict_at_a_cell_of(1)};
    EXPECT_EQ(
        to_json(problem_of(error)),
        R"({"type":"/problems/contradiction","title":"No such model exists","status":422,)"
        R"("detail":"why","conflict":{"sides":["bottom"],"constraints":[{"index":2,)"
        R"("kind":"count"}],"periodic":[],"removed":[],"origin":false,)"
        R"("cells":[{"cell":[1,2,3],"labels":["a"]}],"minimal":true}})"
    );
}

TEST(Explanation, ListsOnlySoManyLabelsOfACell) {
    const auto json_of = [](std::size_t labels) {
        return to_json(
            problem_of({ErrorCode::kContradiction, "why", {}, conflict_at_a_cell_of(labels)})
        );
    };
    EXPECT_EQ(json_of(64).find("more"), std::string::npos);
    EXPECT_NE(json_of(65).find(R"("a"],"more":1})"), std::string::npos);
    EXPECT_EQ(json_of(65).size(), json_of(64).size() + std::string(R"(,"more":1)").size());
}

TEST(Explanation, OfASearchThatGaveUpBecomesItsHottestCells) {
    const Error error = {
        ErrorCode::kGaveUp, "why", {}, discrete::DeadEnds{{{{4, 0, 1}, 7}, {{0, 0, 0}, 2}}}};
    const std::string json = to_json(problem_of(error));
    EXPECT_NE(
        json.find(R"("hottest":[{"cell":[4,0,1],"times":7},{"cell":[0,0,0],"times":2}])"),
        std::string::npos
    ) << json;
}

}  // namespace
}  // namespace modelsynth::proto
