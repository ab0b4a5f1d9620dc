#pragma once

#include "proto/problem.h"
#include "server/jobs/kept_results.h"
#include "solver/registry/task.h"

#include <cstddef>
#include <memory>
#include <stop_token>
#include <string>

namespace modelsynth::server {

// What was found out about examples, and the sheets of their figures; the last ones are kept. See
// kept_results.h for how many are made at a time. Thread-safe; calls block.
class ExampleAnalyses {
  public:
    static constexpr unsigned kSecondsMax = 30;

    // Of the example of that id, whose content never changes.
    // Fails: busy when too many wait, too-large when it takes too long, draining after stop().
    [[nodiscard]] proto::Parsed<std::shared_ptr<const Analysis>> find_or_make(
        const std::string& id, const Example& example
    );

    // The drawing of all figures. Requires: an example of solids (checked). Fails: busy.
    [[nodiscard]] proto::Parsed<std::shared_ptr<const std::string>> find_or_draw_figures(
        const std::string& id, const Example& example
    );

    // Ends what is under way, and all later calls.
    void stop() { stop_.request_stop(); }

  private:
    static constexpr std::size_t kAnalysesKeptMax = 32;
    static constexpr std::size_t kSheetsKeptMax = 4;  // of a megabyte, seldom some more

    [[nodiscard]] proto::Parsed<std::shared_ptr<const Analysis>> make(const Example& example);

    std::stop_source stop_;
    KeptResults<Analysis> analyses_{kAnalysesKeptMax};
    KeptResults<std::string> sheets_{kSheetsKeptMax};
};

}  // namespace modelsynth::server
