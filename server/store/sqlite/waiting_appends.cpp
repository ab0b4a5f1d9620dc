#include "server/store/sqlite/waiting_appends.h"

#include <utility>

namespace modelsynth::server {

std::shared_ptr<WaitingAppends::Batch> WaitingAppends::add(const Lease& lease, Append append) {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Batch>& open = open_[lease.job_id];
    // A link can fail, and shall not take down what others have written.
    const bool joins = open && open->lease.token == lease.token &&
                       open->appends.size() < kAppendsMax && append.progress.artifacts.empty() &&
                       open->appends.back().progress.artifacts.empty();
    if (!joins) {
        open = std::make_shared<Batch>(Batch{lease, {}});
    }
    open->appends.push_back(std::move(append));
    return joins ? nullptr : open;
}

void WaitingAppends::seal(const std::shared_ptr<Batch>& batch) {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(batch->lease.job_id);
    if (found != open_.end() && found->second == batch) {
        open_.erase(found);
    }
}

}  // namespace modelsynth::server
