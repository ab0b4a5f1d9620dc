#pragma once

#include "server/store/types.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace modelsynth::server {

// The appends of a lease that the writer has not begun with become one of its operations: a solver
// logs a block in the tenth of a millisecond, while a commit takes some, and an operation costs
// more than the event that it writes. One that links artifacts stands alone. Thread-safe.
class WaitingAppends {
  public:
    struct Append {
        std::vector<NewEvent> events;
        Progress progress;
        std::function<void(const Stored<std::uint64_t>&)> done;
        std::uint64_t first_seq = 0;  // once written
    };

    // What one operation of the writer's writes, in order. After seal() nothing joins it.
    struct Batch {
        Lease lease;
        std::vector<Append> appends;
    };

    // The batch when it is a new one, which the caller posts; nothing when the append has joined
    // one that was posted before.
    [[nodiscard]] std::shared_ptr<Batch> add(const Lease& lease, Append append);

    // Repeating changes nothing.
    void seal(const std::shared_ptr<Batch>& batch);

  private:
    // The writer's queue is bounded in operations; this bounds what one of them holds.
    static constexpr std::size_t kAppendsMax = 8;

    std::mutex mutex_;
    std::unordered_map<std::string, std::shared_ptr<Batch>> open_;  // by job
};

}  // namespace modelsynth::server
