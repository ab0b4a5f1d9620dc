#pragma once

#include "server/store/event_log.h"
#include "server/stream/wake_signal.h"

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

namespace modelsynth::server {

namespace net = boost::asio;

// Reads a job's log page by page for one connection. The log is read at the reader's own pace, so
// that a slow client costs one cursor and no memory.
// One strand at a time: everything runs on `executor` but the blocking reads, which run on the
// pool.
class EventCursor {
  public:
    // What the cursor works with; log and pool outlive it.
    struct Source {
        EventLog* log;
        net::thread_pool* pool;
        net::any_io_executor executor;
    };

    // `signal` is raised when there may be news of the kind; several cursors may share it.
    EventCursor(
        const Source& source,
        std::string job_id,
        std::uint64_t after,
        std::shared_ptr<WakeSignal> signal,
        EventLog::News news = EventLog::News::kAny
    );
    // With a signal of its own.
    EventCursor(const Source& source, std::string job_id, std::uint64_t after);
    // Hands out no event and waits for the last one alone.
    EventCursor(const Source& source, std::string job_id);
    ~EventCursor();

    EventCursor(const EventCursor&) = delete;
    EventCursor& operator=(const EventCursor&) = delete;

    struct Batch {
        EventPage page;
        bool gone = false;      // the job was deleted, or the store is closed
        bool finished = false;  // the batch ends with the last event there will be
    };

    // The events after the cursor as far as they are there, at most so many. The cursor moves on.
    [[nodiscard]] net::awaitable<Batch> poll(std::size_t events_max);

    // The same, but waits for events: an empty batch when none came within the time.
    // Requires: a signal of its own.
    [[nodiscard]] net::awaitable<Batch> next(std::chrono::milliseconds most);

    // Whether the log has changed since it was polled, as far as is known.
    [[nodiscard]] bool has_news() const;

    [[nodiscard]] const std::string& job_id() const { return job_id_; }

    // Where the cursor stands: the seq of the last event handed out.
    [[nodiscard]] std::uint64_t position() const { return position_; }

    // Passes over what is in between, or goes back to hand it out again.
    void move_to(std::uint64_t seq) { position_ = seq; }

  private:
    struct News;

    EventLog& log_;
    net::thread_pool& pool_;
    std::string job_id_;
    std::uint64_t position_;
    std::shared_ptr<News> news_;
    std::unique_ptr<EventLog::Subscription> subscription_;
};

}  // namespace modelsynth::server
