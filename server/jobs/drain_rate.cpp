#include "server/jobs/drain_rate.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::server {

void DrainRate::on_let_go(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    let_go_.push_back(now);
    if (let_go_.size() > kKept) {
        let_go_.pop_front();
    }
}

std::uint64_t DrainRate::seconds_to_next(Clock::time_point now) const {
    constexpr double kMost = 60;
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> seen = now - let_go_.front();
    const double mean = seen.count() / static_cast<double>(let_go_.size());
    return static_cast<std::uint64_t>(std::ceil(std::clamp(mean, 1.0, kMost)));
}

}  // namespace modelsynth::server
