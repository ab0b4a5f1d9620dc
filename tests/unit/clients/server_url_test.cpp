#include "clients/cli/server_url.h"

#include <gtest/gtest.h>

namespace modelsynth::cli {

TEST(ServerUrl, ReadsHostPortAndPrefix) {
    EXPECT_EQ(*parse_server_url("http://127.0.0.1:8080"), (ServerUrl{"127.0.0.1", "8080", ""}));
    EXPECT_EQ(*parse_server_url("http://example.org"), (ServerUrl{"example.org", "80", ""}));
    EXPECT_EQ(*parse_server_url("http://a-b.c:1/x/y/"), (ServerUrl{"a-b.c", "1", "/x/y"}));
    EXPECT_EQ(*parse_server_url("http://[::1]:65535//"), (ServerUrl{"::1", "65535", ""}));
    EXPECT_EQ(*parse_server_url("http://[fe80::1]"), (ServerUrl{"fe80::1", "80", ""}));
}

TEST(ServerUrl, ReadsHttps) {
    EXPECT_EQ(
        *parse_server_url("https://example.org"), (ServerUrl{"example.org", "443", "", true})
    );
    EXPECT_EQ(*parse_server_url("https://[::1]:80/x"), (ServerUrl{"::1", "80", "/x", true}));
    EXPECT_EQ(parse_server_url("https://a:443")->authority(), "a");
    EXPECT_EQ(parse_server_url("https://a:80")->authority(), "a:80");
}

TEST(ServerUrl, WritesTheHostHeader) {
    EXPECT_EQ((ServerUrl{"127.0.0.1", "8080", ""}.authority()), "127.0.0.1:8080");
    EXPECT_EQ((ServerUrl{"example.org", "80", "/x"}.authority()), "example.org");
    EXPECT_EQ((ServerUrl{"::1", "8080", ""}.authority()), "[::1]:8080");
}

TEST(ServerUrl, RefusesWhatIsNoHttpServer) {
    for (const char* const text :
         {"",
          "127.0.0.1:8080",
          "https//example.org",
          "HTTPS://example.org",
          "https://",
          "http://",
          "http://:80",
          "http://host:",
          "http://host:0",
          "http://host:65536",
          "http://host:80a",
          "http://host:-1",
          "http://user@host",
          "http://ho st",
          "http://[::1",
          "http://[::1]80",
          "http://[host]:80",
          "http://[]",
          "http://host/a?b=c",
          "http://host/a#b",
          "http://host/a\r\nX: y"}) {
        const auto url = parse_server_url(text);
        ASSERT_FALSE(url.has_value()) << text;
        EXPECT_EQ(url.error().code, ExitCode::kWrongUsage) << text;
    }
}

TEST(PercentEncode, EscapesAllButUnreservedCharacters) {
    EXPECT_EQ(percent_encode("aZ09-._~"), "aZ09-._~");
    EXPECT_EQ(percent_encode("a/b?c=d&e%#\r\n"), "a%2Fb%3Fc%3Dd%26e%25%23%0D%0A");
    EXPECT_EQ(percent_encode("\xC3\xA9"), "%C3%A9");
}

}  // namespace modelsynth::cli
