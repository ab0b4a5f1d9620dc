#pragma once

#include "server/store/job_store.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

namespace modelsynth::server {

// How much may run at the same time.
struct CapacityLimits {
    std::uint64_t memory_bytes = 0;  // by the jobs' estimates
    std::uint64_t large_cost = 0;    // a job that costs more is a large one
    std::size_t large_jobs = 1;      // at once; other workers are kept for small ones
};

// Hands out jobs as far as there is room for them. Thread-safe.
class Capacity {
  public:
    explicit Capacity(const CapacityLimits& limits) : limits_(limits) {}

    [[nodiscard]] const CapacityLimits& limits() const { return limits_; }

    // As JobStore::claim(); what was handed out is given back at the end.
    [[nodiscard]] Stored<std::optional<Claim>> claim(JobStore& jobs, proto::UnixMillis now);
    void give_back_memory(const Claim& claim);
    // That of a large job, if it is one.
    void give_back_turn(const Claim& claim);

  private:
    [[nodiscard]] ClaimLimits free();

    [[nodiscard]] bool is_large(const Claim& claim) const {
        return claim.cost > limits_.large_cost;
    }

    const CapacityLimits limits_;
    std::mutex claiming_;
    std::mutex mutex_;                // taken for moments, what follows is guarded by it
    std::uint64_t memory_bytes_ = 0;  // in use
    std::size_t large_jobs_ = 0;      // in hand
};

}  // namespace modelsynth::server
