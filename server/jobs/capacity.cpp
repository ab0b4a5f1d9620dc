#include "server/jobs/capacity.h"

#include <algorithm>

namespace modelsynth::server {

Stored<std::optional<Claim>> Capacity::claim(JobStore& jobs, proto::UnixMillis now) {
    // Two workers must not see the same room.
    const std::lock_guard claiming(claiming_);
    auto claim = jobs.claim(now, free());
    if (claim && *claim) {
        const std::lock_guard lock(mutex_);
        memory_bytes_ += (*claim)->memory_bytes;
        large_jobs_ += is_large(**claim) ? 1U : 0U;
    }
    return claim;
}

ClaimLimits Capacity::free() {
    const std::lock_guard lock(mutex_);
    ClaimLimits free;
    free.memory_bytes_max = limits_.memory_bytes - std::min(limits_.memory_bytes, memory_bytes_);
    if (memory_bytes_ == 0) {
        // Taken by a server with more memory, a job would wait for ever.
        free.memory_bytes_max = ClaimLimits{}.memory_bytes_max;
    }
    if (large_jobs_ >= limits_.large_jobs) {
        free.cost_max = limits_.large_cost;
    }
    return free;
}

void Capacity::give_back_memory(const Claim& claim) {
    const std::lock_guard lock(mutex_);
    memory_bytes_ -= claim.memory_bytes;
}

void Capacity::give_back_turn(const Claim& claim) {
    const std::lock_guard lock(mutex_);
    large_jobs_ -= is_large(claim) ? 1U : 0U;
}

}  // namespace modelsynth::server
