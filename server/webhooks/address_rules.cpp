#include "server/webhooks/address_rules.h"

#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace modelsynth::server {

namespace {

struct Net4 {
    std::uint32_t address;
    int bits;
};

constexpr std::uint32_t v4(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    return a << 24U | b << 16U | c << 8U | d;
}

constexpr std::array<Net4, 15> kNotPublic = {{
    {v4(0, 0, 0, 0), 8},        // this network
    {v4(10, 0, 0, 0), 8},       // private
    {v4(100, 64, 0, 0), 10},    // shared, of carriers
    {v4(127, 0, 0, 0), 8},      // loopback
    {v4(169, 254, 0, 0), 16},   // link-local, and what clouds tell their machines
    {v4(172, 16, 0, 0), 12},    // private
    {v4(192, 0, 0, 0), 24},     // of protocols
    {v4(192, 0, 2, 0), 24},     // of documentation
    {v4(192, 88, 99, 0), 24},   // relays of 6to4, given up
    {v4(192, 168, 0, 0), 16},   // private
    {v4(198, 18, 0, 0), 15},    // of benchmarks
    {v4(198, 51, 100, 0), 24},  // of documentation
    {v4(203, 0, 113, 0), 24},   // of documentation
    {v4(224, 0, 0, 0), 4},      // multicast
    {v4(240, 0, 0, 0), 4},      // reserved, broadcast
}};

bool is_public_v4(std::uint32_t address) {
    return std::none_of(kNotPublic.begin(), kNotPublic.end(), [address](const Net4& net) {
        return (address ^ net.address) >> (32 - net.bits) == 0;
    });
}

using Bytes6 = std::array<std::uint8_t, 16>;

bool has_prefix(const Bytes6& address, std::initializer_list<std::uint8_t> prefix) {
    return std::equal(prefix.begin(), prefix.end(), address.begin());
}

std::uint32_t v4_at(const Bytes6& address, std::size_t at) {
    return v4(address[at], address[at + 1], address[at + 2], address[at + 3]);
}

bool is_public_v6(const Bytes6& address) {
    // IPv4 within IPv6: mapped, and by the translators of providers (RFC 6052).
    if (has_prefix(address, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff}) ||
        has_prefix(address, {0, 0x64, 0xff, 0x9b, 0, 0, 0, 0, 0, 0, 0, 0})) {
        return is_public_v4(v4_at(address, 12));
    }
    if (has_prefix(address, {0x20, 0x02})) {  // 6to4
        return is_public_v4(v4_at(address, 2));
    }
    const bool is_of_protocols = has_prefix(address, {0x20, 0x01}) && address[2] < 2;
    const bool is_of_documentation = has_prefix(address, {0x20, 0x01, 0x0d, 0xb8}) ||
                                     (has_prefix(address, {0x3f, 0xff}) && address[2] < 0x10);
    // 2000::/3 is all that has been given out.
    return (address[0] & 0xe0U) == 0x20 && !is_of_protocols && !is_of_documentation;
}

}  // namespace

bool is_public(const sockaddr* address) {
    if (address->sa_family == AF_INET) {
        sockaddr_in v4_address = {};
        std::memcpy(&v4_address, address, sizeof(v4_address));
        return is_public_v4(ntohl(v4_address.sin_addr.s_addr));
    }
    if (address->sa_family == AF_INET6) {
        sockaddr_in6 v6_address = {};
        std::memcpy(&v6_address, address, sizeof(v6_address));
        Bytes6 bytes = {};
        std::memcpy(bytes.data(), &v6_address.sin6_addr, bytes.size());
        return is_public_v6(bytes);
    }
    return false;
}

}  // namespace modelsynth::server
