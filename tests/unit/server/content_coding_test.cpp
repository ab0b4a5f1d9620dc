#include "server/http/content_coding.h"

#include "server/jobs/gzip.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

namespace modelsynth::server {
namespace {

std::string unpacked(const std::string& file) {
    std::string bytes(1 << 20, '\0');
    z_stream state = {};
    EXPECT_EQ(inflateInit2(&state, 15 + 16), Z_OK);
    std::string input = file;
    state.next_in = reinterpret_cast<Bytef*>(input.data());
    state.avail_in = static_cast<uInt>(input.size());
    state.next_out = reinterpret_cast<Bytef*>(bytes.data());
    state.avail_out = static_cast<uInt>(bytes.size());
    EXPECT_EQ(inflate(&state, Z_FINISH), Z_STREAM_END);
    EXPECT_EQ(state.avail_in, 0U);
    bytes.resize(state.total_out);
    inflateEnd(&state);
    return bytes;
}

std::string sample(std::size_t size) {
    std::string text;
    for (std::size_t i = 0; text.size() < size; ++i) {
        text += std::to_string(i * i % 1009) + ",";
    }
    text.resize(size);
    return text;
}

Request request_with(const std::string& accept_encoding) {
    Request request;
    request.method = "GET";
    request.headers = {{"accept-encoding", accept_encoding}};
    return request;
}

TEST(Gzip, GivesBackWhatWasPacked) {
    for (const std::size_t size : {0U, 1U, 1000U, 65536U, 300000U}) {
        EXPECT_EQ(unpacked(gzipped(sample(size))), sample(size));
    }
}

TEST(Gzip, HasTheSameBytesHoweverItIsCut) {
    const std::string text = sample(200'000);
    GzipWriter writer;
    for (std::size_t at = 0; at < text.size(); at += 777) {
        writer.append(std::string_view(text).substr(at, 777));
    }
    EXPECT_EQ(writer.finish(), gzipped(text));
}

TEST(Gzip, TellsNoTimeAndNoName) {
    const std::string file = gzipped("text");
    EXPECT_EQ(file.substr(0, 8), std::string("\x1F\x8B\x08\0\0\0\0\0", 8));
}

TEST(AcceptEncoding, IsReadWithItsWeights) {
    struct Case {
        const char* list;
        bool identity;
        bool gzip;
        bool prefers_gzip;
    };

    for (const Case& each : {
             Case{"", true, false, false},
             Case{"gzip", true, true, true},
             Case{"GZip", true, true, true},
             Case{"x-gzip", true, true, true},
             Case{"deflate, br", true, false, false},
             Case{"deflate, gzip;q=1.0, *;q=0.5", true, true, true},
             Case{"gzip;q=0.001", true, true, true},
             Case{"gzip ; q=0.5 , identity;q=0.4", true, true, true},
             Case{"gzip;q=0.5, identity", true, true, false},
             Case{"gzip, identity", true, true, true},
             Case{"gzip;q=0", true, false, false},
             Case{"gzip;q=0.000", true, false, false},
             Case{"*", true, true, true},
             Case{"*;q=0", false, false, false},
             Case{"gzip, *;q=0", false, true, true},
             Case{"identity;q=0", false, false, false},
             Case{"identity;q=0, gzip", false, true, true},
             Case{"identity;q=0, *", false, true, true},
             Case{"identity, *;q=0", true, false, false},
             Case{"gzip;q=0, *", true, false, false},
             Case{"br;q=0", true, false, false},
             // Malformed items tell nothing.
             Case{"gzip;q=2", true, false, false},
             Case{"gzip;q=1.001", true, false, false},
             Case{"gzip;q=0.5555", true, false, false},
             Case{"gzip;q=", true, false, false},
             Case{"gzip;q=-1", true, false, false},
             Case{"gzip;level=9", true, false, false},
             Case{"identity;q=nan", true, false, false},
             Case{",,;;q=0,=", true, false, false},
         }) {
        const AcceptedCodings accepted = parse_accept_encoding(std::string(each.list));
        EXPECT_EQ(accepted.identity, each.identity) << each.list;
        EXPECT_EQ(accepted.gzip, each.gzip) << each.list;
        EXPECT_EQ(accepted.prefers_gzip, each.prefers_gzip) << each.list;
    }
    EXPECT_FALSE(parse_accept_encoding(std::nullopt).gzip);
}

TEST(ContentCoding, IsChosenBySizeAtItsEdge) {
    const Request request = request_with("gzip");
    EXPECT_EQ(choose_coding(request, kCodedBytesMin), ContentCoding::kGzip);
    EXPECT_EQ(choose_coding(request, kCodedBytesMin - 1), ContentCoding::kIdentity);
    // Who takes nothing as it is gets even little coded.
    EXPECT_EQ(choose_coding(request_with("gzip, identity;q=0"), 1), ContentCoding::kGzip);
    EXPECT_EQ(choose_coding(request_with("identity;q=0"), 1), std::nullopt);
}

TEST(ContentCoding, LeavesAPartOfABodyAsItIs) {
    Request request = request_with("gzip");
    request.headers.emplace_back("range", "bytes=0-3");
    EXPECT_EQ(choose_coding(request, 5000), ContentCoding::kIdentity);
    request.method = "HEAD";  // has no ranges
    EXPECT_EQ(choose_coding(request, 5000), ContentCoding::kGzip);
}

TEST(ContentCoding, CodesTextAndNothingElse) {
    const auto code = [](const std::string& type) {
        Response response = {200, {{"Content-Type", type}}, sample(5000)};
        code_body(request_with("gzip"), response);
        const auto& body = std::get<std::string>(response.body);
        return body.size() < 5000 && response.headers.size() == 3 && unpacked(body) == sample(5000);
    };
    EXPECT_TRUE(code("application/json"));
    EXPECT_TRUE(code("application/problem+json"));
    EXPECT_TRUE(code("image/svg+xml"));
    EXPECT_TRUE(code("text/plain; charset=utf-8"));
    EXPECT_FALSE(code("image/png"));
    Response events = {200, {{"Content-Type", "text/event-stream"}}, EventStreamBody{"id", 0}};
    code_body(request_with("gzip"), events);
    EXPECT_EQ(events.headers.size(), 1U);
}

TEST(ContentCoding, NeverRefusesAnAnswerThatIsMade) {
    Response response = {202, {{"Content-Type", "application/json"}}, sample(5000)};
    code_body(request_with("identity;q=0"), response);
    EXPECT_EQ(std::get<std::string>(response.body), sample(5000));
    EXPECT_EQ(response.status, 202);
}

}  // namespace
}  // namespace modelsynth::server
