#include "server/http/correlation.h"

#include <gtest/gtest.h>

namespace modelsynth::server {
namespace {

const std::string kTraceparent = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01";

Request taken(Fields headers) {
    Request request;
    request.id = "ours";
    request.headers = std::move(headers);
    take_correlation(request);
    return request;
}

std::string trace_of(const std::string& value) {
    return taken({{"traceparent", value}}).traceparent;
}

TEST(Correlation, TakesTheClientsOwnIdWhenItIsOne) {
    EXPECT_EQ(taken({{"x-request-id", "a.B_c-9"}}).id, "a.B_c-9");
    EXPECT_EQ(taken({{"x-request-id", std::string(64, 'x')}}).id, std::string(64, 'x'));
    for (const std::string& bad :
         {std::string(),
          std::string(65, 'x'),
          std::string("a b"),
          std::string("a\"b"),
          std::string("a/b"),
          std::string("caf\xc3\xa9")}) {
        EXPECT_EQ(taken({{"x-request-id", bad}}).id, "ours") << bad;
    }
    EXPECT_EQ(taken({}).id, "ours");
}

TEST(Correlation, MakesIdsThatDiffer) {
    const std::string first = make_request_id();
    EXPECT_EQ(first.size(), 16U);
    EXPECT_EQ(first.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_NE(first, make_request_id());
}

TEST(Correlation, TakesAWellFormedTrace) {
    EXPECT_EQ(trace_of(kTraceparent), kTraceparent);
    // Of a later version what is known of it.
    const std::string later = "cc" + kTraceparent.substr(2);
    EXPECT_EQ(trace_of(later), later);
    EXPECT_EQ(trace_of(later + "-what-the-future-will-be-like"), later);
}

TEST(Correlation, IgnoresWhatIsNoTrace) {
    const auto with = [](std::size_t at, const std::string& text) {
        std::string changed = kTraceparent;
        return changed.replace(at, text.size(), text);
    };
    for (const std::string& bad :
         {std::string(),
          kTraceparent + "-extra",
          kTraceparent + "x",
          kTraceparent.substr(0, 54),
          with(0, "ff"),
          with(0, "0G"),
          with(2, "_"),
          with(3, std::string(32, '0')),
          with(3, "0AF7"),
          with(36, std::string(16, '0')),
          with(36, "x"),
          with(53, "0x"),
          with(53, "0A"),
          "cc" + kTraceparent.substr(2) + ".x"}) {
        EXPECT_EQ(trace_of(bad), "") << bad;
    }
    EXPECT_EQ(
        taken({{"traceparent", kTraceparent}, {"traceparent", kTraceparent}}).traceparent, ""
    );
}

}  // namespace
}  // namespace modelsynth::server
