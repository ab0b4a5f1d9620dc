#pragma once

#include <string>
#include <string_view>
#include <vector>

// What pages in a browser may ask of a server that trusts whoever reaches it.

namespace modelsynth::server {

struct BrowserRules {
    std::vector<std::string> origins;  // as browsers send them, scheme://host[:port], or "*"
    std::vector<std::string> hosts;    // names without a port
};

// Whether a Host header may name this server. A page can have its own name point here and then
// ask as one of us (DNS rebinding), but only by a name that can be had in the public DNS:
// addresses, names without a dot and those set apart for other uses (RFC 2606, RFC 6761, RFC 6762,
// RFC 8375) are fine, of all others those alone that the rules list.
[[nodiscard]] bool is_host_allowed(std::string_view host, const BrowserRules& rules);

// Whether pages of an origin may change things and read answers: those served from the host that
// the request names, from this machine, and those that the rules list.
[[nodiscard]] bool is_origin_allowed(
    std::string_view origin, std::string_view host, const BrowserRules& rules
);

}  // namespace modelsynth::server
