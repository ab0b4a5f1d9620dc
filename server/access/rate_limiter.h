#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace modelsynth::server {

// How often each owner may ask: a bucket of tokens, one taken by each request, filled at a steady
// rate up to what a second brings, and to one at least. Thread-safe.
class RateLimiter {
  public:
    using Clock = std::chrono::steady_clock;

    struct Verdict {
        bool is_granted = true;
        std::uint64_t quota = 0;           // tokens of a full bucket
        std::uint64_t window_seconds = 0;  // in which an empty one fills
        std::uint64_t remaining = 0;       // tokens left
        std::uint64_t reset_seconds = 0;   // until there is one again, or until the bucket is full
    };

    // Takes a token. Requires: rate > 0, in tokens a second.
    [[nodiscard]] Verdict take(const std::string& owner, double rate, Clock::time_point now);

  private:
    struct Bucket {
        double tokens = 0;
        Clock::time_point filled;
    };

    std::mutex mutex_;
    std::map<std::string, Bucket> buckets_;  // as many as there are owners in the file of keys
};

}  // namespace modelsynth::server
