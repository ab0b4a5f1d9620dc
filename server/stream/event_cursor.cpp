#include "server/stream/event_cursor.h"

#include "server/stream/on_pool.h"

#include <boost/asio/post.hpp>

#include <limits>
#include <utility>

namespace modelsynth::server {

// Outlives the cursor in handlers that are on their way.
struct EventCursor::News {
    explicit News(std::shared_ptr<WakeSignal> raised) : signal(std::move(raised)) {}

    std::shared_ptr<WakeSignal> signal;
    bool is_there = true;
};

EventCursor::EventCursor(
    const Source& source,
    std::string job_id,
    std::uint64_t after,
    std::shared_ptr<WakeSignal> signal,
    EventLog::News news
)
    : log_(*source.log),
      pool_(*source.pool),
      job_id_(std::move(job_id)),
      position_(after),
      news_(std::make_shared<News>(std::move(signal))),
      subscription_(log_.subscribe(job_id_, news, [told = news_, executor = source.executor] {
          net::post(executor, [told] {
              told->is_there = true;
              told->signal->raise();
          });
      })) {}

EventCursor::EventCursor(const Source& source, std::string job_id, std::uint64_t after)
    : EventCursor(source, std::move(job_id), after, std::make_shared<WakeSignal>(source.executor)) {
}

EventCursor::EventCursor(const Source& source, std::string job_id)
    : EventCursor(
          source,
          std::move(job_id),
          std::numeric_limits<std::uint64_t>::max(),
          std::make_shared<WakeSignal>(source.executor),
          EventLog::News::kEnd
      ) {}

EventCursor::~EventCursor() = default;

bool EventCursor::has_news() const { return news_->is_there; }

net::awaitable<EventCursor::Batch> EventCursor::poll(std::size_t events_max) {
    news_->is_there = false;
    auto read = [this, events_max] { return log_.read(job_id_, position_, events_max); };
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
    co_return batch;
}

net::awaitable<EventCursor::Batch> EventCursor::next(std::chrono::milliseconds most) {
    constexpr std::size_t kPage = 256;
    const auto until = std::chrono::steady_clock::now() + most;
    for (;;) {
        news_->signal->lower();
        auto batch = co_await poll(kPage);
        const bool out_of_time = std::chrono::steady_clock::now() >= until;
        if (!batch.page.events.empty() || batch.finished || batch.gone || out_of_time) {
            co_return batch;
        }
        co_await news_->signal->wait_until(until);
    }
}

}  // namespace modelsynth::server
