#include "server/http/representation.h"

#include "server/jobs/gzip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace modelsynth::server {
namespace {

const std::string kText(5000, 'x');

Request make_request(Fields headers) {
    Request request;
    request.method = "GET";
    request.target = "/thing";
    request.headers = std::move(headers);
    return request;
}

std::string header_of(const Response& response, std::string_view name) {
    const auto found =
        std::find_if(response.headers.begin(), response.headers.end(), [name](const auto& field) {
            return field.first == name;
        });
    return found == response.headers.end() ? "" : found->second;
}

std::string tag_of(const Request& request) {
    return header_of(respond_with_json(request, kText), "ETag");
}

const std::pair<std::string, std::string> kGzip = {"accept-encoding", "gzip"};

TEST(Representation, HasATagForEachCoding) {
    const std::string plain = tag_of(make_request({}));
    const std::string coded = tag_of(make_request({kGzip}));
    EXPECT_EQ(plain, "\"" + sha256_hex(kText) + "\"");
    EXPECT_EQ(coded, "\"" + sha256_hex(kText) + "-gzip\"");
}

TEST(Representation, ComparesConditionsWithTheTagOfTheCodingThatIsChosen) {
    const std::string plain = tag_of(make_request({}));
    const std::string coded = tag_of(make_request({kGzip}));
    const auto status = [](Fields headers) {
        return respond_with_json(make_request(std::move(headers)), kText).status;
    };
    EXPECT_EQ(status({{"if-none-match", plain}}), 304);
    EXPECT_EQ(status({{"if-none-match", coded}}), 200);
    EXPECT_EQ(status({kGzip, {"if-none-match", coded}}), 304);
    EXPECT_EQ(status({kGzip, {"if-none-match", "W/" + coded}}), 304);
    EXPECT_EQ(status({kGzip, {"if-none-match", plain}}), 200);
    EXPECT_EQ(status({kGzip, {"if-none-match", plain + ", " + coded}}), 304);
    EXPECT_EQ(status({{"if-match", plain}}), 200);
    EXPECT_EQ(status({{"if-match", coded}}), 412);
    EXPECT_EQ(status({kGzip, {"if-match", coded}}), 200);
    EXPECT_EQ(status({kGzip, {"if-match", plain}}), 412);
    EXPECT_EQ(status({kGzip, {"if-match", "*"}}), 200);
}

TEST(Representation, TakesRangesOfTheContentAsItIs) {
    const std::string plain = tag_of(make_request({}));
    const std::string coded = tag_of(make_request({kGzip}));
    const std::pair<std::string, std::string> range = {"range", "bytes=1-4"};
    const auto part = respond_with_json(make_request({kGzip, range}), kText);
    EXPECT_EQ(part.status, 206);
    EXPECT_EQ(std::get<std::string>(part.body), "xxxx");
    EXPECT_EQ(header_of(part, "ETag"), plain);
    EXPECT_EQ(header_of(part, "Content-Encoding"), "");
    EXPECT_EQ(header_of(part, "Vary"), "Accept-Encoding");
    const auto same = respond_with_json(make_request({kGzip, range, {"if-range", plain}}), kText);
    EXPECT_EQ(same.status, 206);
    // A part of other bytes than those that the client has.
    const auto other = respond_with_json(make_request({kGzip, range, {"if-range", coded}}), kText);
    EXPECT_EQ(other.status, 200);
    EXPECT_EQ(std::get<std::string>(other.body), kText);
    const auto forbidden =
        respond_with_json(make_request({{"accept-encoding", "gzip, identity;q=0"}, range}), kText);
    EXPECT_EQ(forbidden.status, 200);
    EXPECT_EQ(std::get<std::string>(forbidden.body), gzipped(kText));
    EXPECT_EQ(header_of(forbidden, "Accept-Ranges"), "");
}

TEST(Representation, VariesByCodingWhateverTheStatus) {
    const std::string plain = tag_of(make_request({}));
    for (const auto& [headers, status] : std::vector<std::pair<Fields, int>>{
             {{}, 200},
             {{kGzip}, 200},
             {{{"if-none-match", plain}}, 304},
             {{{"if-match", "\"a\""}}, 412},
             {{{"range", "bytes=9999-"}}, 416},
             {{{"accept-encoding", "identity;q=0"}}, 406}}) {
        const auto response = respond_with_json(make_request(headers), kText);
        EXPECT_EQ(response.status, status);
        EXPECT_EQ(header_of(response, "Vary"), "Accept-Encoding") << status;
    }
}

TEST(Representation, IsHadAsItIsWhenItCannotBeCoded) {
    Representation representation = in_memory("application/json", kText);
    int asked = 0;
    representation.gzipped = [&asked]() -> proto::Parsed<Content> {
        ++asked;
        return tl::unexpected(proto::make_problem("unavailable", "the disk is full"));
    };
    const auto plain = respond_with(make_request({kGzip}), representation);
    EXPECT_EQ(plain.status, 200);
    EXPECT_EQ(std::get<std::string>(plain.body), kText);
    EXPECT_EQ(header_of(plain, "ETag"), representation.etag);
    EXPECT_EQ(header_of(plain, "Content-Encoding"), "");
    EXPECT_EQ(asked, 1);
    const Request strict = make_request({{"accept-encoding", "gzip, identity;q=0"}});
    EXPECT_EQ(respond_with(strict, representation).status, 503);
}

class Zeros final : public ArtifactStore::Reader {
  public:
    [[nodiscard]] std::uint64_t size() const override { return 5000; }

    [[nodiscard]] Stored<void> read(std::uint64_t /*offset*/, std::span<char> into) override {
        std::fill(into.begin(), into.end(), '\0');
        return {};
    }
};

TEST(Representation, IsHadAsItIsWhenItIsAFileThatIsNotKeptCoded) {
    Representation representation = {
        "model/gltf-binary", "\"tag\"", "", std::make_shared<Zeros>(), {}};
    const auto respond = [&](Fields headers) {
        return respond_with(make_request(std::move(headers)), representation);
    };
    EXPECT_EQ(header_of(respond({kGzip}), "ETag"), "\"tag\"");
    EXPECT_EQ(respond({kGzip, {"if-match", "\"tag\""}}).status, 200);
    EXPECT_EQ(respond({kGzip, {"if-none-match", "\"tag\""}}).status, 304);
    EXPECT_EQ(respond({{"accept-encoding", "gzip, identity;q=0"}}).status, 406);
}

TEST(Representation, CodesNothingThatIsNotSent) {
    Representation representation = in_memory("application/json", kText);
    representation.gzipped = []() -> proto::Parsed<Content> {
        ADD_FAILURE() << "nobody wants it";
        return Content(std::string());
    };
    const std::string coded = "\"" + sha256_hex(kText) + "-gzip\"";
    EXPECT_EQ(
        respond_with(make_request({kGzip, {"if-none-match", coded}}), representation).status, 304
    );
    EXPECT_EQ(respond_with(make_request({}), representation).status, 200);
}

}  // namespace
}  // namespace modelsynth::server
