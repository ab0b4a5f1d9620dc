#pragma once

#include "proto/stream_message.h"
#include "server/http/connection.h"
#include "server/http/message.h"
#include "server/stream/event_cursor.h"
#include "server/stream/frame_source.h"
#include "server/stream/stream_socket.h"

#include <boost/asio/awaitable.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace modelsynth::server {

// The events of one job on their way to one WebSocket, with frames of what blocks changed where the
// client wants them. Sends in turns, so that several jobs can share a socket; holds no event
// between two turns. On the connection's strand.
class JobFeed {
  public:
    // Whether messages say which job they belong to.
    enum class Naming : std::uint8_t { kNone, kJobId };

    // `signal` is raised when a turn may be worth it. Socket and context outlive the feed.
    JobFeed(
        StreamSocket& socket,
        const ConnectionContext& context,
        std::shared_ptr<WakeSignal> signal,
        JobStream wanted,
        Naming naming
    );

    enum class Turn : std::uint8_t {
        kIdle,     // there was nothing to send
        kBusy,     // there may be more
        kEnded,    // the last event was sent
        kDeleted,  // the job is gone
    };

    // Sends what comes next, at most so many events. Whether the client is still there, the socket
    // tells.
    [[nodiscard]] net::awaitable<Turn> take_turn(std::size_t events_max);

    // When a turn is due although no news came: the signal is a hint, the log is the truth.
    [[nodiscard]] WakeSignal::Clock::time_point due() const { return due_; }

    [[nodiscard]] bool is_due(WakeSignal::Clock::time_point now) const {
        return cursor_.has_news() || now >= due_;
    }

    [[nodiscard]] const std::string& job_id() const { return wanted_.job_id; }

    // The seq of the last event sent.
    [[nodiscard]] std::uint64_t position() const { return cursor_.position(); }

  private:
    [[nodiscard]] net::awaitable<bool> write_page(const EventCursor::Batch& batch);
    [[nodiscard]] net::awaitable<bool> write_event(const Event& event);
    [[nodiscard]] net::awaitable<bool> write_text(const Event& event);
    [[nodiscard]] net::awaitable<bool> write_frame(FrameSource::FramePointer frame);
    [[nodiscard]] net::awaitable<bool> write_whole(
        std::uint64_t seq, FrameSource::WholeIf condition = FrameSource::WholeIf::kAny
    );
    [[nodiscard]] net::awaitable<bool> write_whole_of_block(std::uint64_t seq);
    [[nodiscard]] net::awaitable<bool> catch_up();

    // How often a whole state is waited for; see write_whole_of_block().
    static constexpr int kPausesMax = 20;

    StreamSocket& socket_;
    const ConnectionContext& context_;
    JobStream wanted_;
    Naming naming_;
    EventCursor cursor_;
    WakeSignal::Clock::time_point due_;
    // The client has no state that the next block's frame could be laid upon: at the beginning,
    // and when a frame could not be had. A whole state comes first then.
    bool needs_whole_;
    int pauses_left_ = kPausesMax;
    std::uint64_t whole_seq_ = 0;    // what the whole state that was sent last includes
    std::uint64_t slow_writes_ = 0;  // of the socket, as far as the client was spared for them
};

}  // namespace modelsynth::server
