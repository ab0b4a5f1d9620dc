#pragma once

#include "solver/continuous/problem.h"

#include <list>
#include <memory>
#include <mutex>
#include <stop_token>

namespace modelsynth::continuous {

// Keeps the latest problems, so that requests that differ in their seed alone need not begin from
// nothing, and knows large ones as long as somebody has them. It changes no result. Thread-safe.
class ProblemCache {
  public:
    // Fails: as make_problem().
    [[nodiscard]] Result<std::shared_ptr<const Problem>> find_or_make(
        const std::shared_ptr<const ExampleReading>& reading,
        const Parameters& parameters,
        const std::stop_token& stop = {}
    );

  private:
    struct Entry {
        Parameters parameters;
        std::weak_ptr<const Problem> problem;
        std::shared_ptr<const Problem> kept;  // null: it is too large for that
    };

    static constexpr std::size_t kEntriesMax = 8;
    static constexpr std::size_t kVerticesKeptMax = 500'000;  // of one problem; 200 bytes each

    [[nodiscard]] std::shared_ptr<const Problem> find_locked(
        const ExampleReading& reading, const Parameters& parameters
    );

    std::mutex mutex_;
    std::list<Entry> entries_;  // most recently used first
};

}  // namespace modelsynth::continuous
