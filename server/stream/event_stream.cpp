#include "server/stream/event_stream.h"

#include "proto/job.h"
#include "server/stream/stream_limits.h"

#include <chrono>
#include <utility>

namespace modelsynth::server {

namespace {

// How long a browser waits before it connects again.
constexpr const char* kHello = "retry: 2000\n\n";
constexpr const char* kComment = ": still here\n\n";
constexpr auto kHeartbeat = std::chrono::seconds(kEventStreamHeartbeatSeconds);
constexpr auto kWait = std::chrono::milliseconds(500);

std::string text_of(const EventPage& page) {
    std::string text;
    for (const Event& event : page.events) {
        text += "id: " + std::to_string(event.seq) + "\nevent: " + event.type +
                "\ndata: " + proto::event_json(event.seq, event.type, event.time, event.fields) +
                "\n\n";
    }
    return text;
}

}  // namespace

net::awaitable<bool> write_event_stream(
    EventSink& sink, EventCursor& cursor, const std::atomic<bool>& draining
) {
    using Clock = std::chrono::steady_clock;
    std::string text = kHello;
    auto last_written = Clock::now();
    bool last = false;
    for (;;) {
        if (!text.empty()) {
            if (!co_await sink.write(std::move(text))) {
                co_return false;
            }
            last_written = Clock::now();
        }
        if (last) {
            co_return true;
        }
        if (sink.has_gone()) {
            co_return false;
        }
        const auto batch = co_await cursor.next(kWait);
        text = text_of(batch.page);
        if (text.empty() && Clock::now() - last_written > kHeartbeat) {
            text = kComment;
        }
        last = batch.gone || batch.finished || draining;
    }
}

}  // namespace modelsynth::server
