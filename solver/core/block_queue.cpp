#include "solver/core/block_queue.h"

namespace modelsynth {

BlockQueue::BlockQueue(
    const BlockDependencies& dependencies, std::uint32_t first, std::uint32_t run_ahead
)
    : dependencies_(dependencies),
      run_ahead_(run_ahead),
      waits_for_(dependencies.waits_for),
      finished_(dependencies.waits_for.size()),
      started_(first),
      next_report_(first) {
    for (std::uint32_t block = first; block < waits_for_.size(); ++block) {
        if (waits_for_[block] == 0) {
            ready_.push(block);
        }
    }
}

std::optional<std::uint32_t> BlockQueue::take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_over() || may_start(); });
    return is_over() ? std::nullopt : std::optional(start());
}

BlockQueue::Step BlockQueue::next_step() {
    std::unique_lock lock(mutex_);
    const auto can_report = [this] {
        return next_report_ < finished_.size() && finished_[next_report_];
    };
    const auto at_end = [this] { return is_stopped_ || next_report_ == finished_.size(); };
    changed_.wait(lock, [&] { return at_end() || can_report() || may_start(); });
    if (at_end()) {
        return {Step::Kind::kEnd, 0};
    }
    if (can_report()) {
        changed_.notify_all();  // one more may run ahead
        return {Step::Kind::kReport, next_report_++};
    }
    return {Step::Kind::kSolve, start()};
}

void BlockQueue::finish(std::uint32_t block) {
    const std::lock_guard lock(mutex_);
    finished_[block] = true;
    for (std::uint32_t i = dependencies_.first_dependent[block];
         i < dependencies_.first_dependent[block + 1];
         ++i) {
        const std::uint32_t dependent = dependencies_.dependents[i];
        if (--waits_for_[dependent] == 0) {
            ready_.push(dependent);
        }
    }
    changed_.notify_all();
}

void BlockQueue::stop() {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
}

bool BlockQueue::is_over() const { return is_stopped_ || started_ == finished_.size(); }

bool BlockQueue::may_start() const {
    return !ready_.empty() && ready_.top() < next_report_ + run_ahead_;
}

std::uint32_t BlockQueue::start() {
    const std::uint32_t block = ready_.top();
    ready_.pop();
    ++started_;
    return block;
}

}  // namespace modelsynth
