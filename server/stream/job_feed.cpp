#include "server/stream/job_feed.h"

#include "proto/job.h"
#include "server/stream/on_pool.h"
#include "server/stream/snapshot.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>

#include <utility>

namespace modelsynth::server {

namespace {

using proto::Partial;

bool is_accepted_block(const Event& event) {
    return event.type == "block" &&
           event.fields.find("\"outcome\":\"accepted\"") != std::string::npos;
}

}  // namespace

JobFeed::JobFeed(
    StreamSocket& socket,
    const ConnectionContext& context,
    std::shared_ptr<WakeSignal> signal,
    JobStream wanted,
    Naming naming
)
    : socket_(socket),
      context_(context),
      wanted_(std::move(wanted)),
      naming_(naming),
      cursor_(
          {&context.api->service().events(), context.pool, socket.executor()},
          wanted_.job_id,
          wanted_.after,
          std::move(signal)
      ),
      needs_whole_(wanted_.partial != Partial::kNone),
      slow_writes_(socket.slow_writes()) {}

net::awaitable<JobFeed::Turn> JobFeed::take_turn(std::size_t events_max) {
    constexpr auto kWait = std::chrono::milliseconds(500);
    constexpr auto kWaitForWhole = std::chrono::milliseconds(20);
    if (!co_await catch_up()) {
        co_return Turn::kBusy;
    }
    const auto batch = co_await cursor_.poll(events_max);
    if (batch.gone) {
        co_return Turn::kDeleted;
    }
    if (!co_await write_page(batch)) {
        co_return Turn::kBusy;
    }
    if (batch.finished && cursor_.position() >= batch.page.head) {
        co_return Turn::kEnded;
    }
    if (!batch.page.events.empty()) {
        due_ = {};
        co_return Turn::kBusy;
    }
    if (needs_whole_) {
        // Before the first accepted block there is nothing to show; it brings the state itself.
        const bool open = co_await write_whole(cursor_.position(), FrameSource::WholeIf::kAnyBlock);
        if (!open) {
            co_return Turn::kBusy;
        }
    }
    due_ = WakeSignal::Clock::now() + (needs_whole_ ? kWaitForWhole : kWait);
    co_return Turn::kIdle;
}

net::awaitable<bool> JobFeed::write_page(const EventCursor::Batch& batch) {
    for (const Event& event : batch.page.events) {
        const bool last = batch.finished && event.seq == batch.page.head;
        if (last && needs_whole_ && !co_await write_whole(event.seq - 1)) {
            co_return false;
        }
        if (!co_await write_event(event)) {
            co_return false;
        }
        if (slow_writes_ != socket_.slow_writes()) {
            cursor_.move_to(event.seq);
            co_return co_await catch_up();
        }
    }
    co_return true;
}

net::awaitable<bool> JobFeed::write_event(const Event& event) {
    if (!co_await write_text(event)) {
        co_return false;
    }
    if (wanted_.partial == Partial::kNone) {
        co_return true;
    }
    if (event.type == "alternative" && event.seq > whole_seq_) {
        needs_whole_ = true;  // the next model begins anew
    }
    if (!is_accepted_block(event)) {
        co_return true;
    }
    if (needs_whole_) {  // then the block's frame is the whole state
        co_return co_await write_whole_of_block(event.seq);
    }
    if (event.seq <= whole_seq_) {
        co_return true;  // included already
    }
    auto make = [this, &event] {
        return context_.frames->block_frame(wanted_.job_id, event.seq, wanted_.partial);
    };
    auto frame = co_await on_pool(*context_.pool, make);
    if (!frame) {
        context_.observer->on_events_dropped("frame-not-kept", 1);
        needs_whole_ = true;
        co_return co_await write_whole_of_block(event.seq);
    }
    co_return co_await write_frame(std::move(frame));
}

net::awaitable<bool> JobFeed::write_text(const Event& event) {
    const std::string text =
        naming_ == Naming::kJobId
            ? proto::event_json(wanted_.job_id, event.seq, event.type, event.time, event.fields)
            : proto::event_json(event.seq, event.type, event.time, event.fields);
    co_return co_await socket_.write_text(text);
}

net::awaitable<bool> JobFeed::write_frame(FrameSource::FramePointer frame) {
    const std::string head = naming_ == Naming::kJobId
                                 ? proto::encode_frame_head(*frame, wanted_.job_id)
                                 : proto::encode_frame_head(*frame);
    co_return co_await socket_.write_binary(head, frame->payload);
}

// Sends a whole state that includes everything up to `seq`, if there is one: a job that is solved
// again after a restart has none until it has come so far. False when the client is gone.
net::awaitable<bool> JobFeed::write_whole(std::uint64_t seq, FrameSource::WholeIf condition) {
    auto make = [this, seq, condition] {
        return context_.frames->whole_frame(wanted_.job_id, seq, wanted_.partial, condition);
    };
    auto whole = co_await on_pool(*context_.pool, make);
    if (!whole) {
        co_return true;
    }
    needs_whole_ = false;
    whole_seq_ = whole->seq;
    co_return co_await write_frame(std::move(whole));
}

// The same for a block whose event was just read: it is on disk a moment before the live model has
// its labels, so that is waited for; but not long, since a job that is solved again after a restart
// takes its time to come so far.
net::awaitable<bool> JobFeed::write_whole_of_block(std::uint64_t seq) {
    constexpr auto kPause = std::chrono::milliseconds(2);
    constexpr auto kToken = net::as_tuple(net::use_awaitable);
    bool open = co_await write_whole(seq);
    while (open && needs_whole_ && pauses_left_ > 0) {
        --pauses_left_;
        net::steady_timer timer(socket_.executor(), kPause);
        co_await timer.async_wait(kToken);
        open = co_await write_whole(seq);
    }
    if (!needs_whole_) {
        pauses_left_ = kPausesMax;
    }
    co_return open;
}

// Spares a client that does not keep up the events in between, when they are many.
net::awaitable<bool> JobFeed::catch_up() {
    if (slow_writes_ == socket_.slow_writes()) {
        co_return true;
    }
    slow_writes_ = socket_.slow_writes();
    auto make = [this] {
        return snapshot_after(context_.api->service(), wanted_.job_id, cursor_.position());
    };
    const auto snapshot = co_await on_pool(*context_.pool, make);
    if (!snapshot) {
        co_return true;
    }
    context_.observer->on_events_dropped("slow-reader", snapshot->seq - cursor_.position());
    cursor_.move_to(snapshot->seq);
    needs_whole_ = wanted_.partial != Partial::kNone;
    co_return co_await write_text(*snapshot);
}

}  // namespace modelsynth::server
