#pragma once

#include <sys/socket.h>

namespace modelsynth::server {

// Whether the address is one of the public internet: not loopback, private, link-local, shared,
// multicast, unspecified, of documentation or reserved, nor one of IPv6 that leads to such a one of
// IPv4 (IANA special-purpose registries; RFC 6890). Other families than IPv4 and IPv6 are not.
[[nodiscard]] bool is_public(const sockaddr* address);

}  // namespace modelsynth::server
