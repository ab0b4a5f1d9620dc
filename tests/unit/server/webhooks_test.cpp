// Where webhooks may go, and how they are signed.

#include "server/webhooks/address_rules.h"
#include "server/webhooks/signing.h"
#include "server/webhooks/webhook_url.h"
#include "tests/unit/server/embedded_store.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

#include <fstream>
#include <string>

namespace modelsynth::server {

namespace {

bool is_public_address(const std::string& text) {
    sockaddr_in v4 = {};
    v4.sin_family = AF_INET;
    if (::inet_pton(AF_INET, text.c_str(), &v4.sin_addr) == 1) {
        return is_public(reinterpret_cast<const sockaddr*>(&v4));
    }
    sockaddr_in6 v6 = {};
    v6.sin6_family = AF_INET6;
    EXPECT_EQ(::inet_pton(AF_INET6, text.c_str(), &v6.sin6_addr), 1) << text;
    return is_public(reinterpret_cast<const sockaddr*>(&v6));
}

}  // namespace

TEST(WebhookAddresses, ThoseOfTheInternetArePublic) {
    for (const char* text :
         {"1.1.1.1",          "9.255.255.255",   "11.0.0.0",       "100.63.255.255",
          "100.128.0.0",      "126.255.255.255", "128.0.0.0",      "169.253.255.255",
          "169.255.0.0",      "172.15.255.255",  "172.32.0.0",     "192.0.1.0",
          "192.167.255.255",  "192.169.0.0",     "198.17.255.255", "198.20.0.0",
          "223.255.255.255",  "2606:4700::1111", "2a00:1450::1",   "::ffff:1.1.1.1",
          "64:ff9b::101:101", "2002:101:101::1", "2001:200::1"}) {
        EXPECT_TRUE(is_public_address(text)) << text;
    }
}

TEST(WebhookAddresses, AllOthersAreNot) {
    for (const char* text :
         {"0.0.0.0",
          "0.255.255.255",
          "10.0.0.0",
          "10.255.255.255",
          "100.64.0.0",
          "100.127.255.255",
          "127.0.0.1",
          "127.255.255.255",
          "169.254.0.0",
          "169.254.169.254",
          "172.16.0.0",
          "172.31.255.255",
          "192.0.0.1",
          "192.0.2.1",
          "192.88.99.1",
          "192.168.0.0",
          "192.168.255.255",
          "198.18.0.0",
          "198.19.255.255",
          "198.51.100.1",
          "203.0.113.1",
          "224.0.0.1",
          "239.255.255.255",
          "240.0.0.1",
          "255.255.255.255",
          "::",
          "::1",
          "::ffff:127.0.0.1",
          "::ffff:10.0.0.1",
          "::127.0.0.1",
          "64:ff9b::7f00:1",
          "64:ff9b:1::1",
          "100::1",
          "2001::1",
          "2001:1ff:ffff::1",
          "2001:db8::1",
          "2002:7f00:1::1",
          "2002:a00:1::1",
          "3fff::1",
          "fc00::1",
          "fdff::1",
          "fe80::1",
          "febf::1",
          "fec0::1",
          "ff02::1",
          "4000::1",
          "1fff::1"}) {
        EXPECT_FALSE(is_public_address(text)) << text;
    }
    sockaddr other = {};
    other.sa_family = AF_UNIX;
    EXPECT_FALSE(is_public(&other));
}

TEST(WebhookUrls, TakesWhatIsReachedByTls) {
    for (const char* url :
         {"https://example.com",
          "https://example.com/",
          "HTTPS://Example.com:8443/a/b?c=d&e=%20#f",
          "https://a-b.example:1/",
          "https://a.example:65535",
          "https://1.1.1.1/x",
          "https://[2606:4700::1111]:443/"}) {
        EXPECT_FALSE(find_url_fault(url, {})) << url;
    }
    EXPECT_FALSE(find_url_fault("http://example.com/", {true, false}));
    EXPECT_FALSE(find_url_fault("https://127.0.0.1/", {false, true}));
}

TEST(WebhookUrls, RefusesEverythingElse) {
    for (const char* url :
         {"",
          "example.com",
          "//example.com/",
          "/hook",
          "https://",
          "https:///x",
          "https:/example.com",
          "https://example.com\\@127.0.0.1/",
          "https://example.com\\.b/",
          "https:example.com",
          "http://example.com/",
          "ftp://example.com/",
          "file:///etc/passwd",
          "gopher://example.com/",
          "javascript:1",
          "https://user@example.com/",
          "https://user:password@example.com/",
          "https://:@example.com/",
          "https://example.com:0/",
          "https://example.com:65536/",
          "https://example.com:99999999999/",
          "https://example.com:x/",
          "https://example.com:-1/",
          "https://exa mple.com/",
          "https://example.com/a b",
          "https://example.com/\r\nX: y",
          "https://example.com/\x7f",
          "https://ex\xc3\xa4mple.com/",
          "https://127.0.0.1/",
          "https://127.1/",
          "https://2130706433/",
          "https://0x7f.0.0.1/",
          "https://0177.0.0.1/",
          "https://[::1]/",
          "https://[::ffff:10.0.0.1]/",
          "https://[fe80::1%25eth0]/",
          "https://169.254.169.254/latest",
          "https://[::1",
          "https://0/"}) {
        EXPECT_TRUE(find_url_fault(url, {})) << url;
    }
}

class WebhookSigner : public testing::Test {
  protected:
    [[nodiscard]] std::string write(const std::string& text) const {
        const std::string path = (directory_.path() / "secret").string();
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }

  private:
    TemporaryDirectory directory_;
};

// An example of the Standard Webhooks libraries.
constexpr const char* kSecret = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

std::string signed_example(const Signer& signer) {
    return signer.sign("msg_p5jXN8AQM9LWM0D4loKWxJek", "1614265330", R"({"test": 2432232314})");
}

TEST_F(WebhookSigner, SignsAsTheSpecificationSays) {
    Signer signer(write(std::string(kSecret) + "\n"));
    ASSERT_TRUE(signer.load());
    EXPECT_EQ(signed_example(signer), "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
}

TEST_F(WebhookSigner, SignsWithEachSecret) {
    const std::string other = "whsec_" + std::string(32, 'A');
    Signer signer(write(std::string(kSecret) + "\r\n\n" + other));
    ASSERT_TRUE(signer.load());
    const std::string both = signed_example(signer);
    EXPECT_TRUE(both.starts_with("v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE= v1,"));
}

TEST_F(WebhookSigner, RefusesOtherFilesAndTellsNoSecret) {
    Signer signer(write(kSecret));
    ASSERT_TRUE(signer.load());
    const std::string before = signed_example(signer);
    const std::string short_secret = "whsec_" + std::string(28, 'A');
    const std::string long_secret = "whsec_" + std::string(88, 'A');
    const std::string five =
        std::string(kSecret) + "\n" + kSecret + "\n" + kSecret + "\n" + kSecret + "\n" + kSecret;
    for (const std::string& text :
         {std::string(),
          std::string("\n\n"),
          std::string("MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"),
          std::string("whsec_"),
          std::string("whsec_%%%%"),
          short_secret,
          long_secret,
          five,
          std::string(5000, '\n'),
          std::string(kSecret) + " "}) {
        static_cast<void>(write(text));
        const auto loaded = signer.load();
        ASSERT_FALSE(loaded) << text;
        EXPECT_EQ(loaded.error().find("MfKQ"), std::string::npos);
        EXPECT_EQ(signed_example(signer), before);
    }
    EXPECT_FALSE(Signer("/nowhere/at/all").load());
    EXPECT_FALSE(Signer("/").load());
}

}  // namespace modelsynth::server
