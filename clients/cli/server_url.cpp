#include "clients/cli/server_url.h"

#include <charconv>
#include <cstdint>

namespace modelsynth::cli {

namespace {

// The port as it is sent; empty when it is none.
std::string read_port(std::string_view text) {
    std::uint32_t port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    const bool is_whole = error == std::errc() && end == text.data() + text.size();
    return is_whole && port >= 1 && port <= 65535 ? std::to_string(port) : "";
}

bool is_host_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-' || c == '_';
}

bool is_host(std::string_view host) {
    for (const char c : host) {
        if (!is_host_character(c)) {
            return false;
        }
    }
    return !host.empty();
}

bool is_address(std::string_view host) {
    return host.find_first_not_of("0123456789abcdefABCDEF:.") == std::string_view::npos &&
           host.find(':') != std::string_view::npos;
}

bool is_prefix(std::string_view prefix) {
    for (const char c : prefix) {
        if (c <= ' ' || c >= 0x7f || c == '?' || c == '#') {
            return false;
        }
    }
    return true;
}

}  // namespace

std::string ServerUrl::authority() const {
    const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
    return port == (is_tls ? "443" : "80") ? name : name + ":" + port;
}

Outcome<ServerUrl> parse_server_url(std::string_view text) {
    const auto refuse = [text](const std::string& why) {
        return wrong_usage("the server \"" + std::string(text) + "\" " + why);
    };
    ServerUrl url;
    url.is_tls = text.starts_with("https://");
    const std::string_view scheme = url.scheme();
    if (!text.starts_with(scheme)) {
        return refuse("is not a URL like http://127.0.0.1:8080");
    }
    const std::string_view rest = text.substr(scheme.size());
    const std::size_t slash = rest.find('/');
    const std::string_view place = rest.substr(0, slash);
    std::string_view port = url.is_tls ? "443" : "80";
    if (place.starts_with('[')) {
        const std::size_t close = place.find(']');
        url.host = place.substr(1, close == std::string_view::npos ? close : close - 1);
        const std::string_view after =
            close == std::string_view::npos ? "" : place.substr(close + 1);
        port = after.empty() ? port : after.starts_with(':') ? after.substr(1) : "";
        if (close == std::string_view::npos || !is_address(url.host)) {
            return refuse("has no usable host");
        }
    } else {
        const std::size_t colon = place.find(':');
        url.host = place.substr(0, colon);
        port = colon == std::string_view::npos ? port : place.substr(colon + 1);
        if (!is_host(url.host)) {
            return refuse("has no usable host");
        }
    }
    url.port = read_port(port);
    if (url.port.empty()) {
        return refuse("has no usable port");
    }
    std::string_view prefix = slash == std::string_view::npos ? "" : rest.substr(slash);
    while (prefix.ends_with('/')) {
        prefix.remove_suffix(1);
    }
    if (!is_prefix(prefix)) {
        return refuse("has a query, a fragment or an unescaped character");
    }
    url.prefix = prefix;
    return url;
}

std::string percent_encode(std::string_view text) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string encoded;
    for (const char c : text) {
        if (is_host_character(c) || c == '~') {
            encoded += c;
            continue;
        }
        const auto byte = static_cast<unsigned char>(c);
        encoded += '%';
        encoded += kDigits[byte >> 4U];
        encoded += kDigits[byte & 15U];
    }
    return encoded;
}

}  // namespace modelsynth::cli
