#pragma once

#include "proto/key_codec.h"

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace modelsynth::server {

// Tickets for streams of browsers, which cannot send a key: each opens one stream, soon, and stands
// for the key that it was given to. Kept in memory, since one that is lost is asked for again.
// Thread-safe.
class Tickets {
  public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::chrono::seconds kLifetime{30};
    static constexpr std::size_t kCountMax = 10'000;

    struct Ticket {
        proto::KeyEntry key;
        std::string job_id;  // empty: any that the key may see
    };

    // Nothing when there are as many as are kept.
    [[nodiscard]] std::optional<std::string> give(Ticket ticket, Clock::time_point now);

    // Nothing when it was never given, was used, or has expired.
    [[nodiscard]] std::optional<Ticket> take(const std::string& text, Clock::time_point now);

  private:
    struct Given {
        Ticket ticket;
        Clock::time_point until;
    };

    std::mutex mutex_;
    std::map<std::string, Given> given_;
};

}  // namespace modelsynth::server
