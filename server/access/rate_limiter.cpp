#include "server/access/rate_limiter.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::server {

RateLimiter::Verdict RateLimiter::take(
    const std::string& owner, double rate, Clock::time_point now
) {
    const double full = std::max(1.0, std::ceil(rate));
    const std::lock_guard lock(mutex_);
    Bucket& bucket = buckets_.try_emplace(owner, Bucket{full, now}).first->second;
    const std::chrono::duration<double> passed = now - bucket.filled;
    bucket.tokens = std::min(full, bucket.tokens + std::max(0.0, passed.count()) * rate);
    bucket.filled = std::max(bucket.filled, now);
    Verdict verdict;
    verdict.quota = static_cast<std::uint64_t>(full);
    verdict.window_seconds = static_cast<std::uint64_t>(std::ceil(full / rate));
    verdict.is_granted = bucket.tokens >= 1;
    if (verdict.is_granted) {
        bucket.tokens -= 1;
    }
    verdict.remaining = static_cast<std::uint64_t>(bucket.tokens);
    const double missing = verdict.is_granted ? full - bucket.tokens : 1 - bucket.tokens;
    verdict.reset_seconds = static_cast<std::uint64_t>(std::ceil(missing / rate));
    return verdict;
}

}  // namespace modelsynth::server
