#include "server/stream/event_stream.h"

#include "proto/job.h"
#include "server/stream/on_pool.h"
#include "server/stream/snapshot.h"

#include <chrono>
#include <utility>

namespace modelsynth::server {

namespace {

// How long a browser waits before it connects again.
constexpr const char* kHello = "retry: 2000\n\n";
constexpr const char* kComment = ": still here\n\n";
constexpr auto kWait = std::chrono::milliseconds(500);

std::string text_of(const Event& event) {
    return "id: " + std::to_string(event.seq) + "\nevent: " + event.type +
           "\ndata: " + proto::event_json(event.seq, event.type, event.time, event.fields) + "\n\n";
}

}  // namespace

net::awaitable<bool> write_event_stream(
    EventSink& sink, EventCursor& cursor, EventStreamContext context
) {
    using Clock = std::chrono::steady_clock;
    std::string text = kHello;
    auto last_written = Clock::now();
    bool last = false;
    for (;;) {
        bool slow = false;
        if (!text.empty()) {
            const auto begun = Clock::now();
            if (!co_await sink.write(std::move(text))) {
                co_return false;
            }
            last_written = Clock::now();
            slow = last_written - begun > kSlowWrite;
        }
        if (last) {
            co_return true;
        }
        if (sink.has_gone()) {
            co_return false;
        }
        text.clear();
        if (slow) {
            auto make = [&context, &cursor] {
                return snapshot_after(*context.service, cursor.job_id(), cursor.position());
            };
            if (const auto snapshot = co_await on_pool(*context.pool, make)) {
                context.observer->on_events_dropped(
                    "slow-reader", snapshot->seq - cursor.position()
                );
                cursor.move_to(snapshot->seq);
                text = text_of(*snapshot);
                continue;
            }
        }
        const bool is_last_look = *context.draining;
        const auto batch = co_await cursor.next(kWait);
        for (const Event& event : batch.page.events) {
            text += text_of(event);
        }
        if (text.empty() && Clock::now() - last_written > context.heartbeat) {
            text = kComment;
        }
        last = batch.gone || batch.finished || (is_last_look && batch.page.events.empty());
    }
}

}  // namespace modelsynth::server
