#pragma once

#include <cstddef>
#include <cstdint>

// What streams keep to, for those who tell of it.

namespace modelsynth::server {

inline constexpr std::size_t kSocketMessageBytesMax = 4096;  // from a client
inline constexpr std::uint32_t kSocketIdleSeconds = 60;      // pings keep it open
inline constexpr std::uint32_t kEventStreamHeartbeatSeconds = 15;

}  // namespace modelsynth::server
