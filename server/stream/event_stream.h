#pragma once

#include "server/http/http_observer.h"
#include "server/jobs/job_service.h"
#include "server/stream/event_cursor.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>

#include <atomic>
#include <chrono>
#include <string>

namespace modelsynth::server {

// Where the text of an event stream goes.
class EventSink {
  public:
    virtual ~EventSink() = default;

    // False when the client is gone.
    [[nodiscard]] virtual net::awaitable<bool> write(std::string text) = 0;

    // Whether the client has gone, as far as one sees without writing.
    [[nodiscard]] virtual bool has_gone() = 0;
};

// What event streams share; all of it outlives them.
struct EventStreamContext {
    JobService* service;
    net::thread_pool* pool;
    const std::atomic<bool>* draining;
    std::chrono::milliseconds heartbeat;  // a silence of this length is broken by a comment
    HttpObserver* observer;
};

// A job's log as Server-Sent Events from the cursor on: an id, a type and the event's JSON each, a
// comment now and then in a silence; a snapshot in place of what a slow client lost. True when it
// came to its end: after the last event there will be, when the job was deleted or the server
// drains. False when the client is gone.
[[nodiscard]] net::awaitable<bool> write_event_stream(
    EventSink& sink, EventCursor& cursor, EventStreamContext context
);

}  // namespace modelsynth::server
