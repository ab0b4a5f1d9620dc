#include "server/jobs/example_analyses.h"

#include "proto/analysis_codec.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace modelsynth::server {

namespace {

using proto::make_problem;

constexpr std::chrono::seconds kLongest(ExampleAnalyses::kSecondsMax);

// Asks for a stop when the time is up or another stop was asked for.
class Alarm {
  public:
    Alarm(std::chrono::seconds time, const std::stop_token& other)
        : other_(other, [this] { stop_.request_stop(); }),
          thread_([this, time](const std::stop_token& done) {
              std::mutex mutex;
              std::unique_lock lock(mutex);
              std::condition_variable_any ended;
              ended.wait_for(lock, done, time, [] { return false; });
              stop_.request_stop();
          }) {}

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

  private:
    std::stop_source stop_;
    std::stop_callback<std::function<void()>> other_;
    std::jthread thread_;
};

}  // namespace

proto::Parsed<std::shared_ptr<const Analysis>> ExampleAnalyses::find_or_make(
    const std::string& id, const Example& example
) {
    return analyses_.find_or_make(id, [&] { return make(example); });
}

proto::Parsed<std::shared_ptr<const std::string>> ExampleAnalyses::find_or_draw_figures(
    const std::string& id, const Example& example
) {
    return sheets_.find_or_make(id, [&]() -> proto::Parsed<std::shared_ptr<const std::string>> {
        return std::make_shared<const std::string>(proto::figure_drawing(example, std::nullopt));
    });
}

proto::Parsed<std::shared_ptr<const Analysis>> ExampleAnalyses::make(const Example& example) {
    const Alarm alarm(kLongest, stop_.get_token());
    auto analysis = analyse(example, alarm.token());
    if (analysis) {
        return std::make_shared<const Analysis>(std::move(*analysis));
    }
    if (stop_.stop_requested()) {
        return tl::unexpected(make_problem("draining", "the server is stopping"));
    }
    return tl::unexpected(make_problem(
        "too-large",
        "the example could not be analysed within " + std::to_string(kLongest.count()) + " seconds"
    ));
}

}  // namespace modelsynth::server
