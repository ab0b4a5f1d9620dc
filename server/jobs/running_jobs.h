#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace modelsynth::server {

// Why a running job was told to stop; the first reason counts.
enum class StopReason : std::uint8_t {
    kNone,
    kCancelled,
    kDeadline,
    kErased,
    kDraining,
    kLost,  // the store does not take what it has to say
};

// The jobs that workers have in hand, and the ways to stop them. A thread of its own watches the
// deadlines, since a solver deep in a propagation asks only its stop token, and for jobs that go on
// although they were told to stop: what is made ready for millions of cells takes moments in which
// no solver asks. Thread-safe.
class RunningJobs {
  public:
    using Clock = std::chrono::steady_clock;

    static constexpr auto kPatience = std::chrono::milliseconds(20);

    // One job in hand; ends with the object.
    class Entry {
      public:
        // `on_lingering` is called when the job is still in hand kPatience after it was told to
        // stop for a reason of its own: once, on the watching thread. It must not block nor call
        // back.
        Entry(RunningJobs& jobs, std::string id, std::function<void()> on_lingering);
        ~Entry();

        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;

        void set_deadline(Clock::time_point deadline);
        void request_stop(StopReason reason);

        [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

        [[nodiscard]] StopReason reason() const;

      private:
        friend class RunningJobs;

        RunningJobs& jobs_;
        std::string id_;
        std::function<void()> on_lingering_;
        std::stop_source source_;
        StopReason reason_ = StopReason::kNone;  // guarded by jobs_.mutex_
        Clock::time_point deadline_ = Clock::time_point::max();
        Clock::time_point patience_ends_ = Clock::time_point::max();
    };

    RunningJobs();
    ~RunningJobs();

    RunningJobs(const RunningJobs&) = delete;
    RunningJobs& operator=(const RunningJobs&) = delete;

    // Stops the job now, or as soon as a worker that claimed it takes it in hand.
    void stop(const std::string& id, StopReason reason);
    // Stops every job in hand, and every one that is taken in hand later.
    void stop_all(StopReason reason);

    // Waits, but not once everything is told to stop: then it answers no.
    bool pause(std::chrono::milliseconds duration);

    // A claimed job has ended; requests to stop it are forgotten.
    void settle(const std::string& id);

  private:
    void watch(const std::stop_token& stop);
    void stop_entry(Entry& entry, StopReason reason);

    std::mutex mutex_;
    std::condition_variable_any changed_;
    bool times_changed_ = false;
    std::map<std::string, Entry*> entries_;
    std::map<std::string, StopReason> early_;  // asked for before the entry was there
    StopReason stop_all_ = StopReason::kNone;
    std::jthread watcher_;
};

}  // namespace modelsynth::server
