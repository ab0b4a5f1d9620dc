#pragma once

#include "clients/cli/failure.h"

#include <string>
#include <string_view>

namespace modelsynth::cli {

// Where the server is: http[s]://HOST[:PORT][/PREFIX].
struct ServerUrl {
    std::string host;    // as a resolver takes it: an IPv6 address has no brackets
    std::string port;    // decimal, 1 ... 65535
    std::string prefix;  // "" or "/..." without a slash at the end, put before every path

    bool is_tls = false;

    // What it begins with.
    [[nodiscard]] const char* scheme() const { return is_tls ? "https://" : "http://"; }

    // The Host header; the port is left out where it is that of the scheme.
    [[nodiscard]] std::string authority() const;

    friend bool operator==(const ServerUrl&, const ServerUrl&) = default;
};

// Fails: kWrongUsage for anything but http and https, for user names, queries and fragments.
[[nodiscard]] Outcome<ServerUrl> parse_server_url(std::string_view text);

// The text as one segment of a path or one value of a query (RFC 3986): all but unreserved
// characters are escaped.
[[nodiscard]] std::string percent_encode(std::string_view text);

}  // namespace modelsynth::cli
