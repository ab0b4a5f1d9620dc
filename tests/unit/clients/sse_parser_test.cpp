#include "clients/cli/sse_parser.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::cli {

namespace {

using Events = std::vector<SseEvent>;

// All events of a stream given whole.
Events read_whole(std::string_view stream) {
    return SseParser().feed(stream).value_or(Events{{"refused", "", ""}});
}

// All events of a stream given in pieces of `piece` bytes.
Events read_in_pieces(std::string_view stream, std::size_t piece) {
    SseParser parser;
    Events all;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
        const auto events = parser.feed(stream.substr(at, piece));
        if (!events) {
            return {{"refused", "", ""}};
        }
        all.insert(all.end(), events->begin(), events->end());
    }
    return all;
}

}  // namespace

TEST(SseParser, ReadsTypeDataAndId) {
    EXPECT_EQ(
        read_whole("id: 7\nevent: block\ndata: {\"seq\":7}\n\n"),
        (Events{{"block", "{\"seq\":7}", "7"}})
    );
}

TEST(SseParser, AnyCutGivesTheSameEvents) {
    const std::string stream =
        "\xEF\xBB\xBF: hello\r\nretry: 10\r\nid: 1\r\nevent: queued\r\ndata: a\r\n\r\n"
        "id:2\rdata:b\rdata: c\r\rdata\n\nevent: x\n\n: keep alive\n\nid: 3\ndata:  d\n\n";
    const Events expected = {
        {"queued", "a", "1"},
        {"message", "b\nc", "2"},
        {"message", "", "2"},
        {"message", " d", "3"}};
    EXPECT_EQ(read_whole(stream), expected);
    for (std::size_t piece = 1; piece < stream.size(); ++piece) {
        EXPECT_EQ(read_in_pieces(stream, piece), expected) << "in pieces of " << piece;
    }
}

TEST(SseParser, DropsAnEventThatTheStreamEndsWithin) {
    EXPECT_EQ(read_whole("data: a\n\nid: 2\ndata: b\n"), (Events{{"message", "a", ""}}));
}

TEST(SseParser, GivesNoEventWithoutData) {
    EXPECT_EQ(read_whole("event: block\n\ndata: a\n\n"), (Events{{"message", "a", ""}}));
}

TEST(SseParser, KeepsTheIdForLaterEventsAndLetsItBeEmptied) {
    EXPECT_EQ(
        read_whole("id: 4\ndata: a\n\ndata: b\n\nid\ndata: c\n\n"),
        (Events{{"message", "a", "4"}, {"message", "b", "4"}, {"message", "c", ""}})
    );
}

TEST(SseParser, IgnoresAnIdWithAZeroByte) {
    using namespace std::string_view_literals;
    EXPECT_EQ(read_whole("id: 1\0\ndata: a\n\n"sv), (Events{{"message", "a", ""}}));
}

TEST(SseParser, IgnoresUnknownFieldsAndColonsInValues) {
    EXPECT_EQ(read_whole("dat: x\ndata: a: b:c\n\n"), (Events{{"message", "a: b:c", ""}}));
}

TEST(SseParser, TakesAByteOrderMarkOnlyAtTheStart) {
    EXPECT_EQ(
        read_whole("data: a\n\n\xEF\xBB\xBF"
                   "data: b\n\n"),
        (Events{{"message", "a", ""}})
    );
}

TEST(SseParser, RefusesAnEventThatIsTooLongAndStaysRefusing) {
    SseParser parser(16);
    EXPECT_TRUE(parser.feed("data: 0123456\n\n").has_value());
    EXPECT_FALSE(parser.feed("data: 0123456789a").has_value());
    EXPECT_FALSE(parser.feed("\n\ndata: a\n\n").has_value());
}

TEST(SseParser, CountsTheLinesOfAnEventTogether) {
    SseParser parser(16);
    EXPECT_TRUE(parser.feed("data: 01234567\n").has_value());
    EXPECT_FALSE(parser.feed("data: 01234567\n").has_value());
}

}  // namespace modelsynth::cli
