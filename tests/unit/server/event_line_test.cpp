#include "server/log/event_line.h"

#include "server/ops/logging.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spdlog/details/log_msg.h>

#include <algorithm>
#include <random>

namespace modelsynth::server {
namespace {

using nlohmann::json;

json object_of(const std::string& line) { return json::parse('{' + json_members_of(line) + '}'); }

bool is_one_printable_line(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

std::string random_text(std::mt19937& random, std::size_t length_max) {
    // Mostly of what means something in a line.
    static const std::string kTelling = "\"\\= \n\r\t\x1b{}[]:,u0a\xc3\xa9\xe2\x80\xa8\xff";
    std::string text(random() % (length_max + 1), '\0');
    for (char& c : text) {
        c = random() % 4 == 0 ? static_cast<char>(random()) : kTelling[random() % kTelling.size()];
    }
    return text;
}

TEST(EventLine, HasItsFieldsAfterTheText) {
    const std::string line = event_line(
        "job ended", {{"job", "01j8"}, {"state", "it failed"}, {"seconds", 0.25}, {"blocks", 12}}
    );
    EXPECT_EQ(line, R"(job ended job=01j8 state="it failed" seconds=0.25 blocks=12)");
    EXPECT_EQ(
        object_of(line),
        json(
            {{"event", "job ended"},
             {"job", "01j8"},
             {"state", "it failed"},
             {"seconds", 0.25},
             {"blocks", 12}}
        )
    );
}

TEST(EventLine, LeavesOutWhatThereIsNothingToTellOf) {
    EXPECT_EQ(event_line("request", {{"key", ""}, {"status", 200}}), "request status=200");
}

TEST(EventLine, TextThatLooksLikeANumberStaysText) {
    for (const char* text : {"17", "-1.5e3", "0", "1e5"}) {
        EXPECT_EQ(object_of(event_line("request", {{"request", text}}))["request"], text);
    }
    EXPECT_EQ(object_of(event_line("request", {{"request", "007"}}))["request"], "007");
}

TEST(EventLine, KeepsWhatOthersWriteWithinOneFieldOfOneLine) {
    const std::string forged = "x\" status=200\n2026-01-01T00:00:00.000Z info all is well key=\"y";
    const std::string line = event_line("request", {{"key", forged}, {"status", 403}});
    EXPECT_TRUE(is_one_printable_line(line)) << line;
    EXPECT_EQ(object_of(line), json({{"event", "request"}, {"key", forged}, {"status", 403}}));
    const std::string spaced = "caf\xc3\xa9\xe2\x80\xa8\xf0\x9f\x8f\xb0";  // also a line separator
    EXPECT_EQ(object_of(event_line("request", {{"key", spaced}}))["key"], spaced);
    EXPECT_EQ(
        object_of(event_line("request", {{"key", "\xff\xc0\x80\xed\xa0\x80"}}))["key"].size(), 1U
    );
}

TEST(EventLine, SurvivesAnyBytes) {
    std::mt19937 random(7);
    for (int i = 0; i < 3000; ++i) {
        const std::string value = random_text(random, 40);
        const std::string line = event_line("request", {{"key", value}, {"status", 200}});
        ASSERT_TRUE(is_one_printable_line(line)) << line;
        const json object = object_of(line);
        ASSERT_EQ(object["status"], 200) << line;
        ASSERT_EQ(object.size(), value.empty() ? 2U : 3U) << line;
    }
}

TEST(EventLine, AnyOtherTextIsTheEventAsAWhole) {
    EXPECT_EQ(object_of("what=1=2"), json({{"event", "what=1=2"}}));
    EXPECT_EQ(object_of("a b=\"\\q\""), json({{"event", "a b=\"\\q\""}}));
    EXPECT_EQ(object_of("a b=\"open"), json({{"event", "a b=\"open"}}));
    std::mt19937 random(8);
    for (int i = 0; i < 3000; ++i) {
        const std::string text = random_text(random, 40);
        ASSERT_TRUE(object_of(text).contains("event")) << text;
        ASSERT_TRUE(is_one_printable_line(printable(text)));
    }
}

TEST(LogLine, TellsTimeAndLevelInBothFormats) {
    using namespace std::chrono;
    const spdlog::log_clock::time_point time(milliseconds(1'700'000'000'007));
    const std::string payload = event_line("started", {{"workers", 2}});
    const spdlog::details::log_msg message(
        time, spdlog::source_loc(), "modelsynthd", spdlog::level::warn, payload
    );
    EXPECT_EQ(
        log_line(LogFormat::kText, message), "2023-11-14T22:13:20.007Z warning started workers=2\n"
    );
    EXPECT_EQ(
        log_line(LogFormat::kJson, message),
        "{\"time\":\"2023-11-14T22:13:20.007Z\",\"level\":\"warning\",\"event\":\"started\","
        "\"workers\":2}\n"
    );
}

}  // namespace
}  // namespace modelsynth::server
