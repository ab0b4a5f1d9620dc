#include "solver/core/block_queue.h"

namespace modelsynth {

BlockQueue::BlockQueue(
    const GridSize& model,
    Periodic periodic,
    std::span<const Box> blocks,
    std::uint32_t first,
    std::uint32_t run_ahead
)
    : model_(model),
      periodic_(periodic),
      blocks_(blocks),
      window_(run_ahead),
      waiting_(model, blocks),
      admitted_(first),
      started_(first),
      next_report_(first) {
    admit();
}

std::optional<std::uint32_t> BlockQueue::take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_over() || !ready_.empty(); });
    return is_over() ? std::nullopt : std::optional(start());
}

BlockQueue::Step BlockQueue::next_step() {
    std::unique_lock lock(mutex_);
    const auto can_report = [this] {
        return next_report_ < admitted_ && state(next_report_).is_finished;
    };
    const auto at_end = [this] { return is_stopped_ || next_report_ == blocks_.size(); };
    changed_.wait(lock, [&] { return at_end() || can_report() || !ready_.empty(); });
    if (at_end()) {
        return {Step::Kind::kEnd, 0};
    }
    if (can_report()) {
        const std::uint32_t block = next_report_++;
        waiting_.remove(block, blocks_[block]);
        admit();
        changed_.notify_all();
        return {Step::Kind::kReport, block};
    }
    return {Step::Kind::kSolve, start()};
}

void BlockQueue::finish(std::uint32_t block) {
    const std::lock_guard lock(mutex_);
    state(block).is_finished = true;
    for (const std::uint32_t dependent : state(block).dependents) {
        if (--state(dependent).waits_for == 0) {
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

bool BlockQueue::is_over() const { return is_stopped_ || started_ == blocks_.size(); }

void BlockQueue::admit() {
    for (; admitted_ < blocks_.size() && admitted_ - next_report_ < window_.size(); ++admitted_) {
        Waiting& later = state(admitted_);
        later.waits_for = 0;
        later.is_finished = false;
        later.dependents.clear();
        const Box& box = blocks_[admitted_];
        waiting_.for_each_near(box, [&](std::uint32_t earlier) {
            if (!state(earlier).is_finished &&
                blocks_meet(blocks_[earlier], box, model_, periodic_)) {
                state(earlier).dependents.push_back(admitted_);
                ++later.waits_for;
            }
        });
        waiting_.add(admitted_, box);
        if (later.waits_for == 0) {
            ready_.push(admitted_);
        }
    }
}

std::uint32_t BlockQueue::start() {
    const std::uint32_t block = ready_.top();
    ready_.pop();
    ++started_;
    return block;
}

}  // namespace modelsynth
