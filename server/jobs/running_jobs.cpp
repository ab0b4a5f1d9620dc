#include "server/jobs/running_jobs.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

RunningJobs::Entry::Entry(RunningJobs& jobs, std::string id, std::function<void()> on_lingering)
    : jobs_(jobs), id_(std::move(id)), on_lingering_(std::move(on_lingering)) {
    const std::lock_guard lock(jobs_.mutex_);
    jobs_.entries_[id_] = this;
    const auto early = jobs_.early_.find(id_);
    if (early != jobs_.early_.end()) {
        jobs_.stop_entry(*this, early->second);
    } else if (jobs_.stop_all_ != StopReason::kNone) {
        jobs_.stop_entry(*this, jobs_.stop_all_);
    }
}

RunningJobs::Entry::~Entry() {
    const std::lock_guard lock(jobs_.mutex_);
    jobs_.entries_.erase(id_);
}

void RunningJobs::Entry::set_deadline(Clock::time_point deadline) {
    const std::lock_guard lock(jobs_.mutex_);
    deadline_ = deadline;
    jobs_.times_changed_ = true;
    jobs_.changed_.notify_all();
}

void RunningJobs::Entry::request_stop(StopReason reason) {
    const std::lock_guard lock(jobs_.mutex_);
    jobs_.stop_entry(*this, reason);
}

StopReason RunningJobs::Entry::reason() const {
    const std::lock_guard lock(jobs_.mutex_);
    return reason_;
}

RunningJobs::RunningJobs() : watcher_([this](const std::stop_token& stop) { watch(stop); }) {}

RunningJobs::~RunningJobs() {
    watcher_.request_stop();
    watcher_.join();
}

void RunningJobs::stop(const std::string& id, StopReason reason) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(id);
    if (found != entries_.end()) {
        stop_entry(*found->second, reason);
    } else {
        early_.emplace(id, reason);
    }
}

void RunningJobs::stop_all(StopReason reason) {
    const std::lock_guard lock(mutex_);
    stop_all_ = reason;
    for (const auto& [id, entry] : entries_) {
        stop_entry(*entry, reason);
    }
    changed_.notify_all();
}

bool RunningJobs::pause(std::chrono::milliseconds duration) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_for(lock, duration, [this] { return stop_all_ != StopReason::kNone; });
}

void RunningJobs::settle(const std::string& id) {
    const std::lock_guard lock(mutex_);
    early_.erase(id);
}

void RunningJobs::stop_entry(Entry& entry, StopReason reason) {
    if (entry.reason_ == StopReason::kNone) {
        entry.reason_ = reason;
        entry.source_.request_stop();
        if (reason == StopReason::kCancelled || reason == StopReason::kDeadline ||
            reason == StopReason::kErased) {
            entry.patience_ends_ = Clock::now() + kPatience;
            times_changed_ = true;
            changed_.notify_all();
        }
    }
}

void RunningJobs::watch(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        auto next = Clock::now() + std::chrono::hours(1);
        for (const auto& [id, entry] : entries_) {
            if (entry->deadline_ <= Clock::now()) {
                stop_entry(*entry, StopReason::kDeadline);
                entry->deadline_ = Clock::time_point::max();
            }
            if (entry->patience_ends_ <= Clock::now()) {
                entry->patience_ends_ = Clock::time_point::max();
                entry->on_lingering_();
            }
            next = std::min({next, entry->deadline_, entry->patience_ends_});
        }
        times_changed_ = false;
        changed_.wait_until(lock, stop, next, [this] { return times_changed_; });
    }
}

}  // namespace modelsynth::server
