#include "server/jobs/example_analyses.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <thread>

namespace modelsynth::server {

namespace {

using proto::make_problem;

constexpr std::chrono::seconds kLongest(30);

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

}  // namespace

proto::Parsed<std::shared_ptr<const Analysis>> ExampleAnalyses::find_or_make(
    const std::string& id, const Example& example
) {
    if (auto known = find(id)) {
        return known;
    }
    const Caller caller(callers_);
    if (caller.number() > kCallersMax) {
        return tl::unexpected(make_problem("busy", "other examples are being analysed"));
    }
    const std::lock_guard working(working_);
    if (auto known = find(id)) {
        return known;
    }
    auto made = make(example);
    if (made) {
        const std::lock_guard lock(mutex_);
        kept_.emplace_front(id, *made);
        if (kept_.size() > kKeptMax) {
            kept_.pop_back();
        }
    }
    return made;
}

std::shared_ptr<const Analysis> ExampleAnalyses::find(const std::string& id) {
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
