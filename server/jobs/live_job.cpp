#include "server/jobs/live_job.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

namespace {

void lay(const Patch& patch, Model& model) {
    model.space->copy_in(patch.labels, patch.region, model.labels);
}

}  // namespace

LiveJob::LiveJob(std::shared_ptr<const ModelSpace> space)
    : base_{std::move(space), std::vector<Label>()} {
    base_.labels.assign(base_.space->site_count(), kNoLabel);
}

void LiveJob::start(std::uint64_t seq, std::span<const Label> model, bool any_block) {
    const std::lock_guard lock(mutex_);
    base_seq_ = seq;
    head_seq_ = seq;
    base_has_block_ = any_block;
    patches_.clear();
    patch_bytes_ = 0;
    if (model.empty()) {
        std::fill(base_.labels.begin(), base_.labels.end(), kNoLabel);
    } else {
        base_.labels.assign(model.begin(), model.end());
    }
}

void LiveJob::apply(std::shared_ptr<const Patch> patch) {
    const std::lock_guard lock(mutex_);
    head_seq_ = std::max(head_seq_, patch->seq);
    patch_bytes_ += patch->labels.size() * sizeof(Label);
    patches_.push_back(std::move(patch));
    while (patch_bytes_ > kPatchBytesMax) {
        lay(*patches_.front(), base_);
        base_seq_ = patches_.front()->seq;
        base_has_block_ = true;
        patch_bytes_ -= patches_.front()->labels.size() * sizeof(Label);
        patches_.pop_front();
    }
}

void LiveJob::pass(std::uint64_t seq) {
    const std::lock_guard lock(mutex_);
    head_seq_ = std::max(head_seq_, seq);
}

LiveJob::State LiveJob::build(std::uint64_t seq) const {
    State state = {seq, base_, base_has_block_};
    for (const auto& patch : patches_) {
        if (patch->seq <= seq) {
            lay(*patch, state.model);
            state.any_block = true;
        }
    }
    return state;
}

LiveJob::State LiveJob::state() const {
    const std::lock_guard lock(mutex_);
    return build(head_seq_);
}

std::optional<LiveJob::State> LiveJob::state_at(std::uint64_t seq) const {
    const std::lock_guard lock(mutex_);
    if (head_seq_ == 0 || head_seq_ < seq) {
        return std::nullopt;
    }
    return build(std::max(seq, base_seq_));
}

std::shared_ptr<const Patch> LiveJob::patch(std::uint64_t seq) const {
    const std::lock_guard lock(mutex_);
    const auto found = std::lower_bound(
        patches_.begin(),
        patches_.end(),
        seq,
        [](const auto& patch, std::uint64_t wanted) { return patch->seq < wanted; }
    );
    return found != patches_.end() && (*found)->seq == seq ? *found : nullptr;
}

std::size_t LiveJob::bytes() const {
    const std::lock_guard lock(mutex_);
    return patch_bytes_ + base_.labels.size() * sizeof(Label);
}

void LiveJobs::add(const std::string& id, std::shared_ptr<LiveJob> job) {
    const std::lock_guard lock(mutex_);
    retired_.remove(id);
    jobs_[id] = std::move(job);
}

std::shared_ptr<LiveJob> LiveJobs::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? nullptr : found->second;
}

void LiveJobs::retire(const std::string& id) {
    const std::lock_guard lock(mutex_);
    if (!jobs_.contains(id)) {
        return;
    }
    retired_.push_back(id);
    std::size_t bytes = 0;
    for (const std::string& retired : retired_) {
        bytes += jobs_.at(retired)->bytes();
    }
    while (!retired_.empty() && (retired_.size() > kRetiredMax || bytes > kRetiredBytesMax)) {
        bytes -= jobs_.at(retired_.front())->bytes();
        jobs_.erase(retired_.front());
        retired_.pop_front();
    }
}

void LiveJobs::forget(const std::string& id) {
    const std::lock_guard lock(mutex_);
    retired_.remove(id);
    jobs_.erase(id);
}

}  // namespace modelsynth::server
