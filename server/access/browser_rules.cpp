#include "server/access/browser_rules.h"

#include <boost/asio/ip/address.hpp>

#include <algorithm>
#include <array>

namespace modelsynth::server {

namespace {

namespace ip = boost::asio::ip;

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c;
    });
    return result;
}

// The name or address of host[:port], without brackets, without the dot of the root.
std::string name_of_host(std::string_view host) {
    std::string name;
    if (host.starts_with('[')) {
        const std::size_t end = host.find(']');
        name = end == std::string_view::npos ? "" : std::string(host.substr(1, end - 1));
    } else {
        name = lower(host.substr(0, host.find(':')));
    }
    if (name.ends_with('.')) {
        name.pop_back();
    }
    return name;
}

bool is_address(const std::string& name) {
    boost::system::error_code error;
    ip::make_address(name, error);
    return !error;
}

bool is_this_machine(const std::string& name) {
    if (name == "localhost" || name.ends_with(".localhost")) {
        return true;
    }
    boost::system::error_code error;
    const auto address = ip::make_address(name, error);
    return !error && address.is_loopback();
}

}  // namespace

bool is_host_allowed(std::string_view host, const BrowserRules& rules) {
    static constexpr std::array<std::string_view, 10> kSetApart = {
        ".localhost",
        ".test",
        ".example",
        ".invalid",
        ".example.com",
        ".example.net",
        ".example.org",
        ".local",
        ".internal",
        ".home.arpa"};
    const std::string name = name_of_host(host);
    if (name.find('.') == std::string::npos || is_address(name)) {
        return true;
    }
    const std::string dotted = "." + name;
    return std::any_of(
               kSetApart.begin(),
               kSetApart.end(),
               [&dotted](std::string_view suffix) { return dotted.ends_with(suffix); }
           ) ||
           std::any_of(rules.hosts.begin(), rules.hosts.end(), [&name](const std::string& listed) {
               return lower(listed) == name;
           });
}

bool is_origin_allowed(std::string_view origin, std::string_view host, const BrowserRules& rules) {
    const auto listed = [&rules](std::string_view wanted) {
        return std::find(rules.origins.begin(), rules.origins.end(), wanted) != rules.origins.end();
    };
    if (listed("*") || listed(origin)) {
        return true;
    }
    const std::size_t scheme = origin.find("://");
    if (scheme == std::string_view::npos ||
        (origin.substr(0, scheme) != "http" && origin.substr(0, scheme) != "https")) {
        return false;
    }
    const std::string_view origin_host = origin.substr(scheme + 3);
    return is_this_machine(name_of_host(origin_host)) || lower(origin_host) == lower(host);
}

}  // namespace modelsynth::server
