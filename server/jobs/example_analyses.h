#pragma once

#include "proto/problem.h"
#include "solver/registry/task.h"

#include <atomic>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

namespace modelsynth::server {

// What was found out about examples; the last ones are kept. One is analysed at a time, and few
// callers wait for that, so that a seconds' work asked for many times takes no more than one
// processor and leaves threads for others. Thread-safe; calls block.
class ExampleAnalyses {
  public:
    // Of the example of that id, whose content never changes.
    // Fails: busy when too many wait, too-large when it takes too long, draining after stop().
    [[nodiscard]] proto::Parsed<std::shared_ptr<const Analysis>> find_or_make(
        const std::string& id, const Example& example
    );

    // Ends what is under way, and all later calls.
    void stop() { stop_.request_stop(); }

  private:
    using Entry = std::pair<std::string, std::shared_ptr<const Analysis>>;

    static constexpr std::size_t kKeptMax = 32;
    static constexpr int kCallersMax = 2;  // the one that works, and one that waits

    [[nodiscard]] std::shared_ptr<const Analysis> find(const std::string& id);
    [[nodiscard]] proto::Parsed<std::shared_ptr<const Analysis>> make(const Example& example);

    std::stop_source stop_;
    std::atomic<int> callers_ = 0;
    std::mutex working_;
    std::mutex mutex_;
    std::list<Entry> kept_;  // most recently used first
};

}  // namespace modelsynth::server
