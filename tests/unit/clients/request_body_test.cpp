#include "clients/cli/request_body.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>

namespace modelsynth::cli {

TEST(ParseSize, ReadsThreeCounts) {
    EXPECT_EQ(parse_size("40x10x41"), (std::array<std::uint32_t, 3>{40, 10, 41}));
}

TEST(ParseSize, RefusesAllElse) {
    for (const char* const text :
         {"",
          "40",
          "40x10",
          "40x10x",
          "x10x40",
          "40x10x40x1",
          "40x10x40 ",
          " 40x10x40",
          "40X10X40",
          "-1x10x40",
          "+1x10x40",
          "4.5x10x40",
          "99999999999x10x40"}) {
        EXPECT_FALSE(parse_size(text).has_value()) << text;
    }
}

TEST(RequestBody, LeavesOutWhatWasNotGiven) {
    RequestOptions options;
    options.example = "castle";
    EXPECT_EQ(*make_request_body(options), R"({"solver":"discrete","example":"castle"})");
}

TEST(RequestBody, PutsTheSizeWithTheParametersAsTheyWereWritten) {
    RequestOptions options;
    options.example = "ca\"stle";
    options.size = "4x5x6";
    options.seed = 7;
    options.parameters = R"( { "order" : "scan" })";
    options.priority = -3;
    options.deadline_seconds = 1.5;
    options.tags = {"level=3", "note=a=b"};
    EXPECT_EQ(
        *make_request_body(options),
        R"({"solver":"discrete","example":"ca\"stle","seed":7,)"
        R"("parameters": {"size":[4,5,6], "order" : "scan" },"priority":-3,"deadline":1.5,)"
        R"("tags":{"level":"3","note":"a=b"}})"
    );
    options.parameters = "{}";
    EXPECT_NE(
        make_request_body(options)->find(R"("parameters":{"size":[4,5,6]})"), std::string::npos
    );
}

TEST(RequestBody, LeavesToAnEarlierJobWhatWasNotGiven) {
    RequestOptions options;
    options.from = "01\"ab";
    EXPECT_EQ(*make_request_body(options), R"({"from":{"job":"01\"ab"}})");
    options.at = "1,2,3";
    options.box = "0,0,0:4,5,6";
    options.size = "10x5x12";
    options.seed = 7;
    EXPECT_EQ(
        *make_request_body(options),
        R"({"from":{"job":"01\"ab","at":[1,2,3],"box":{"min":[0,0,0],"max":[4,5,6]}},"seed":7,)"
        R"("parameters":{"size":[10,5,12]}})"
    );
    options.example = "castle";
    options.solver = "other";
    EXPECT_TRUE(
        make_request_body(options)->starts_with(R"({"solver":"other","example":"castle","from":{)")
    );
}

TEST(RequestBody, RefusesWhatIsNoRequest) {
    const auto refuses = [](auto change) {
        RequestOptions options;
        options.example = "castle";
        change(options);
        const auto body = make_request_body(options);
        return !body && body.error().code == ExitCode::kWrongUsage;
    };
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.size = "4x5"; }));
    for (const char* const box :
         {"1,2,3",
          "0,0,0:",
          ":1,2,3",
          "0,0,0:1,2",
          "0,0,0:1,2,3:",
          "0,0,-1:1,2,3",
          "0x0x0:1x2x3"}) {
        EXPECT_TRUE(refuses([box](RequestOptions& options) {
            options.from = "a";
            options.box = box;
        })) << box;
    }
    EXPECT_TRUE(refuses([](RequestOptions& options) {
        options.from = "a";
        options.at = "1x2x3";
    }));
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.parameters = "{"; }));
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.parameters = "{} {}"; }));
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.parameters = "no-such-file"; }));
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.example = "no-such-file.json"; }));
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.tags = {"level"}; }));
    EXPECT_TRUE(refuses([](RequestOptions& options) { options.tags = {"=3"}; }));
    EXPECT_TRUE(refuses([](RequestOptions& options) {
        options.deadline_seconds = std::numeric_limits<double>::infinity();
    }));
}

}  // namespace modelsynth::cli
