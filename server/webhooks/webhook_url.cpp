#include "server/webhooks/webhook_url.h"

#include "server/webhooks/address_rules.h"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <netinet/in.h>

#include <algorithm>
#include <memory>

namespace modelsynth::server {

namespace {

using Url = std::unique_ptr<CURLU, decltype(&curl_url_cleanup)>;

// A part of the URL; empty when it has none.
std::string part_of(CURLU* url, CURLUPart part) {
    char* text = nullptr;
    if (curl_url_get(url, part, &text, 0) != CURLUE_OK) {
        return "";
    }
    std::string copy = text;
    curl_free(text);
    return copy;
}

// A host that is an address and not public.
bool is_private_address(std::string host) {
    sockaddr_in v4 = {};
    v4.sin_family = AF_INET;
    if (::inet_pton(AF_INET, host.c_str(), &v4.sin_addr) == 1) {
        return !is_public(reinterpret_cast<const sockaddr*>(&v4));
    }
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
        host = host.substr(1, host.size() - 2);
    }
    sockaddr_in6 v6 = {};
    v6.sin6_family = AF_INET6;
    return ::inet_pton(AF_INET6, host.c_str(), &v6.sin6_addr) == 1 &&
           !is_public(reinterpret_cast<const sockaddr*>(&v6));
}

}  // namespace

std::optional<std::string> find_url_fault(const std::string& url, const WebhookRules& rules) {
    const bool is_text =
        std::all_of(url.begin(), url.end(), [](char c) { return c > 32 && c < 127; });
    if (!is_text) {
        return "must be of printable ASCII, all else escaped";
    }
    // The library takes one slash for two, and three.
    const std::size_t colon = url.find(':');
    if (colon == std::string::npos || !url.substr(colon).starts_with("://") ||
        url.substr(colon).starts_with(":///")) {
        return "is not a URL like https://example.com/hook";
    }
    const Url parsed(curl_url(), &curl_url_cleanup);
    switch (curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), CURLU_DISALLOW_USER)) {
        case CURLUE_OK:
            break;
        case CURLUE_USER_NOT_ALLOWED:
            return "must not hold a user name or password; what is sent is signed instead";
        case CURLUE_BAD_PORT_NUMBER:
            return "has no usable port";
        case CURLUE_UNSUPPORTED_SCHEME:
            return rules.allow_http ? "must begin with https:// or http://"
                                    : "must begin with https://";
        default:
            return "is not a URL like https://example.com/hook";
    }
    const std::string scheme = part_of(parsed.get(), CURLUPART_SCHEME);
    if (scheme == "http" && !rules.allow_http) {
        return "must begin with https://; this server sends no webhooks without TLS "
               "(--webhook-allow-http)";
    }
    if (scheme != "https" && scheme != "http") {
        return rules.allow_http ? "must begin with https:// or http://"
                                : "must begin with https://";
    }
    if (const std::string port = part_of(parsed.get(), CURLUPART_PORT); port == "0") {
        return "has no usable port";
    }
    if (!rules.allow_private && is_private_address(part_of(parsed.get(), CURLUPART_HOST))) {
        return "is of an address that is not public (--webhook-allow-private)";
    }
    return std::nullopt;
}

}  // namespace modelsynth::server
