#pragma once

#include "server/store/event_log.h"

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace modelsynth::server {

namespace net = boost::asio;

// Reads a job's log page by page for one connection, waiting where it ends. The log is read at
// the reader's own pace, so that a slow client costs one cursor and no memory.
// One strand at a time: everything runs on `executor` but the blocking reads, which run on the
// pool.
class EventCursor {
  public:
    // Requires: log and pool outlive the cursor.
    EventCursor(
        EventLog& log,
        net::thread_pool& pool,
        const net::any_io_executor& executor,
        std::string job_id,
        std::uint64_t after
    );
    ~EventCursor();

    EventCursor(const EventCursor&) = delete;
    EventCursor& operator=(const EventCursor&) = delete;

    struct Batch {
        EventPage page;
        bool gone = false;      // the job was deleted, or the store is closed
        bool finished = false;  // the batch ends with the last event there will be
    };

    // The events after the cursor, which moves on; an empty batch when none came within the time
    // or wake() was called.
    [[nodiscard]] net::awaitable<Batch> next(std::chrono::milliseconds most);

    // Where the cursor stands: the seq of the last event handed out.
    [[nodiscard]] std::uint64_t position() const { return position_; }

    // Passes over what is in between.
    void skip_to(std::uint64_t seq) { position_ = seq; }

    // Ends a wait early. From the executor only.
    void wake();

  private:
    struct Signal;

    EventLog& log_;
    net::thread_pool& pool_;
    std::string job_id_;
    std::uint64_t position_;
    std::shared_ptr<Signal> signal_;
    std::unique_ptr<EventLog::Subscription> subscription_;
};

}  // namespace modelsynth::server
