#pragma once

#include "proto/problem.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace modelsynth::server {

// Results that take long to make, by id; the last ones are kept. One is made at a time, and few
// callers wait for that, so that a seconds' work asked for many times takes no more than one
// processor and leaves threads for others. Thread-safe; calls block.
template <class T>
class KeptResults {
  public:
    explicit KeptResults(std::size_t kept_max) : kept_max_(kept_max) {}

    // What `make()` gives, a Parsed<std::shared_ptr<const T>>, or gave for this id before.
    // Fails: as make(), which is not kept; busy when too many wait.
    template <class Make>
    [[nodiscard]] proto::Parsed<std::shared_ptr<const T>> find_or_make(
        const std::string& id, const Make& make
    ) {
        if (auto known = find(id)) {
            return known;
        }
        const Caller caller(callers_);
        if (caller.number() > kCallersMax) {
            return tl::unexpected(proto::make_problem("busy", "other examples are being analysed"));
        }
        const std::lock_guard working(working_);
        if (auto known = find(id)) {
            return known;
        }
        auto made = make();
        if (made) {
            const std::lock_guard lock(mutex_);
            kept_.emplace_front(id, *made);
            if (kept_.size() > kept_max_) {
                kept_.pop_back();
            }
        }
        return made;
    }

  private:
    using Entry = std::pair<std::string, std::shared_ptr<const T>>;

    static constexpr int kCallersMax = 2;  // the one that works, and one that waits

    // Counts a caller while it is there.
    class Caller {
      public:
        explicit Caller(std::atomic<int>& count) : count_(count), number_(++count) {}

        Caller(const Caller&) = delete;
        Caller& operator=(const Caller&) = delete;

        ~Caller() { --count_; }

        [[nodiscard]] int number() const { return number_; }

      private:
        std::atomic<int>& count_;
        int number_;
    };

    [[nodiscard]] std::shared_ptr<const T> find(const std::string& id) {
        const std::lock_guard lock(mutex_);
        const auto found = std::find_if(kept_.begin(), kept_.end(), [&id](const Entry& entry) {
            return entry.first == id;
        });
        if (found == kept_.end()) {
            return nullptr;
        }
        kept_.splice(kept_.begin(), kept_, found);
        return kept_.front().second;
    }

    const std::size_t kept_max_;
    std::atomic<int> callers_ = 0;
    std::mutex working_;
    std::mutex mutex_;
    std::list<Entry> kept_;  // most recently used first
};

}  // namespace modelsynth::server
