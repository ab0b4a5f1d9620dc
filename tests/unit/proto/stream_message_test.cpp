#include "proto/stream_message.h"

#include "proto/frame.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace modelsynth::proto {
namespace {

std::vector<std::string> places(const StreamRefusal& refusal) {
    std::vector<std::string> found;
    for (const Fault& fault : refusal.problem.errors) {
        found.push_back(fault.pointer);
    }
    return found;
}

TEST(StreamRequest, TakesASubscriptionWithItsDefaults) {
    const auto request = parse_stream_request(R"({"id": "a", "type": "subscribe", "job": "j1"})");
    ASSERT_TRUE(request);
    EXPECT_EQ(request->id, "\"a\"");
    EXPECT_EQ(request->type, StreamRequestType::kSubscribe);
    EXPECT_EQ(request->job_id, "j1");
    EXPECT_EQ(request->after, 0U);
    EXPECT_EQ(request->partial, Partial::kNone);
}

TEST(StreamRequest, TakesEveryField) {
    const auto request = parse_stream_request(
        R"({"id": 7, "type": "subscribe", "job": "j1", "after": 12, "partial": "glb"})"
    );
    ASSERT_TRUE(request);
    EXPECT_EQ(request->id, "7");
    EXPECT_EQ(request->after, 12U);
    EXPECT_EQ(request->partial, Partial::kGlb);
}

TEST(StreamRequest, NamesEveryFaultAndKeepsTheId) {
    const auto request = parse_stream_request(
        R"({"id": "x", "type": "subscribe", "job": 3, "after": -1, "partial": "all", "more": 1})"
    );
    ASSERT_FALSE(request);
    EXPECT_EQ(request.error().id, "\"x\"");
    EXPECT_EQ(request.error().problem.status, 422);
    EXPECT_EQ(
        places(request.error()), (std::vector<std::string>{"/job", "/after", "/partial", "/more"})
    );
}

TEST(StreamRequest, TakesNoFieldOfAnotherType) {
    for (const std::string type : {"unsubscribe", "cancel"}) {
        const auto request =
            parse_stream_request(R"({"id": 1, "job": "j", "after": 1, "type": ")" + type + "\"}");
        ASSERT_FALSE(request);
        EXPECT_EQ(places(request.error()), std::vector<std::string>{"/after"});
    }
}

TEST(StreamRequest, MissesWhatIsNotThere) {
    const auto request = parse_stream_request("{}");
    ASSERT_FALSE(request);
    EXPECT_EQ(request.error().id, "null");
    EXPECT_EQ(places(request.error()), (std::vector<std::string>{"/id", "/job", "/type"}));
}

TEST(StreamRequest, AnIdIsAShortStringOrAWholeNumber) {
    const auto with_id = [](const std::string& id) {
        return parse_stream_request(R"({"type": "cancel", "job": "j", "id": )" + id + "}");
    };
    const std::string longest(kRequestIdCharactersMax, 'i');
    for (const std::string& good :
         {std::string("0"),
          std::string("9007199254740991"),
          "\"" + longest + "\"",
          std::string(R"("\"\u00e4")")}) {
        EXPECT_TRUE(with_id(good)) << good;
    }
    for (const std::string& bad :
         {std::string("-1"),
          std::string("1.5"),
          std::string("9007199254740992"),
          std::string("\"\""),
          std::string("null"),
          std::string("[1]"),
          "\"" + longest + "i\""}) {
        const auto request = with_id(bad);
        ASSERT_FALSE(request) << bad;
        EXPECT_EQ(request.error().id, "null");
        EXPECT_EQ(places(request.error()), std::vector<std::string>{"/id"});
    }
}

TEST(StreamRequest, BrokenJsonIsRefusedWithItsPlace) {
    for (const std::string text : {"", "{", "[1,2", "{\"id\": 1} x"}) {
        const auto request = parse_stream_request(text);
        ASSERT_FALSE(request) << text;
        EXPECT_EQ(request.error().problem.status, 400) << text;
        EXPECT_NE(request.error().problem.detail.find("byte"), std::string::npos) << text;
    }
    EXPECT_FALSE(parse_stream_request(R"({"id": 1, "id": 2})"));
    const std::string deep = std::string(1000, '[') + std::string(1000, ']');
    EXPECT_FALSE(parse_stream_request(deep));
    EXPECT_FALSE(parse_stream_request("[]"));
    EXPECT_FALSE(parse_stream_request("null"));
}

TEST(StreamMessage, AnswersCarryTheIdAsItWasSent) {
    const StreamRequest request = {R"("q\"1")", StreamRequestType::kSubscribe, "j1", 3};
    EXPECT_EQ(
        subscribed_json(request, 9),
        R"({"type":"answer","id":"q\"1","request":"subscribe","job_id":"j1","after":3,"head":9})"
    );
    EXPECT_EQ(
        stream_end_json("j1", StreamEndReason::kDeleted, 4),
        R"({"type":"end","job_id":"j1","reason":"deleted","seq":4})"
    );
}

TEST(StreamMessage, AnEventBeginsWithTheJobsId) {
    EXPECT_EQ(
        event_json("j1", 2, "queued", 0, R"({"position":1})"),
        R"({"job_id":"j1","seq":2,"type":"queued","time":"1970-01-01T00:00:00.000Z","position":1})"
    );
}

TEST(NamedFrame, SurvivesTheWireAndRefusesWhatIsNotWhole) {
    const Frame frame = {FrameKind::kLabels, 77, {{1, 2, 3}, {4, 3, 4}}, "abcdef"};
    for (const std::string id : {"", "j", "job", "job1", "job-12345"}) {
        const std::string bytes = encode_frame_head(frame, id) + frame.payload;
        EXPECT_EQ((bytes.size() - frame.payload.size()) % 4, 0U);
        const auto decoded = decode_named_frame(bytes);
        ASSERT_TRUE(decoded) << id;
        EXPECT_EQ(decoded->job_id, id);
        EXPECT_EQ(decoded->frame.seq, frame.seq);
        EXPECT_EQ(decoded->frame.region, frame.region);
        EXPECT_EQ(decoded->frame.payload, frame.payload);
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            EXPECT_FALSE(decode_named_frame(bytes.substr(0, length)));
        }
        EXPECT_FALSE(decode_named_frame(bytes + "x"));
        EXPECT_FALSE(decode_frame(bytes));
    }
    EXPECT_FALSE(decode_named_frame(encode_frame(frame)));
}

TEST(NamedFrame, HasZerosAfterTheId) {
    const Frame frame = {FrameKind::kGlb, 1, {{0, 0, 0}, {1, 1, 1}}, "glTF"};
    std::string bytes = encode_frame_head(frame, "job12") + frame.payload;
    ASSERT_TRUE(decode_named_frame(bytes));
    bytes[kFrameHeaderBytes + 6] = 'x';
    EXPECT_FALSE(decode_named_frame(bytes));
}

}  // namespace
}  // namespace modelsynth::proto
