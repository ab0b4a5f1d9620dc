#include "server/stream/event_cursor.h"

#include "server/stream/on_pool.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

#include <utility>

namespace modelsynth::server {

// Outlives the cursor in handlers that are on their way.
struct EventCursor::Signal {
    explicit Signal(const net::any_io_executor& executor) : timer(executor) {}

    net::steady_timer timer;
    bool raised = false;
};

EventCursor::EventCursor(
    EventLog& log,
    net::thread_pool& pool,
    const net::any_io_executor& executor,
    std::string job_id,
    std::uint64_t after
)
    : log_(log),
      pool_(pool),
      job_id_(std::move(job_id)),
      position_(after),
      signal_(std::make_shared<Signal>(executor)),
      subscription_(log.subscribe(job_id_, [signal = signal_, executor] {
          net::post(executor, [signal] {
              signal->raised = true;
              signal->timer.cancel();
          });
      })) {}

EventCursor::~EventCursor() = default;

void EventCursor::wake() {
    signal_->raised = true;
    signal_->timer.cancel();
}

net::awaitable<EventCursor::Batch> EventCursor::next(std::chrono::milliseconds most) {
    constexpr std::size_t kPage = 256;
    const auto until = std::chrono::steady_clock::now() + most;
    for (;;) {
        signal_->raised = false;
        auto read = [this] { return log_.read(job_id_, position_, kPage); };
        auto page = co_await on_pool(pool_, read);
        Batch batch;
        if (!page) {
            batch.gone = true;
            co_return batch;
        }
        if (!page->events.empty()) {
            position_ = page->events.back().seq;
        }
        batch.finished = page->ended && position_ >= page->head;
        batch.page = std::move(*page);
        const bool out_of_time = std::chrono::steady_clock::now() >= until;
        if (!batch.page.events.empty() || batch.finished || out_of_time) {
            co_return batch;
        }
        if (!signal_->raised) {
            signal_->timer.expires_at(until);
            constexpr auto kToken = net::as_tuple(net::use_awaitable);
            co_await signal_->timer.async_wait(kToken);
        }
    }
}

}  // namespace modelsynth::server
