#include "server/stream/websocket.h"

#include "proto/frame.h"
#include "proto/job.h"
#include "proto/timestamp.h"
#include "server/stream/event_cursor.h"
#include "server/stream/on_pool.h"
#include "server/stream/stream_limits.h"
#include "solver/mesh/glb_writer.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Socket = websocket::stream<beast::tcp_stream>;

constexpr auto kToken = net::as_tuple(net::use_awaitable);

// A client that needed this long for one write does not keep up.
constexpr auto kSlowWrite = std::chrono::seconds(2);
// ... and is then spared the events in between when there are more than this.
constexpr std::uint64_t kLagMax = 64;

// What the two halves of a session share. Both run on the connection's strand.
struct Session {
    Session(beast::tcp_stream stream, const SocketUpgrade& wanted, const ConnectionContext& shared)
        : socket(std::move(stream)),
          upgrade(wanted),
          context(shared),
          cursor(
              shared.api->service().events(),
              *shared.pool,
              socket.get_executor(),
              wanted.job_id,
              wanted.after
          ),
          needs_whole(wanted.partial != Partial::kNone) {}

    Socket socket;
    SocketUpgrade upgrade;
    ConnectionContext context;
    EventCursor cursor;
    bool peer_gone = false;
    websocket::close_reason closing;  // why we close; none: the peer closed
    bool slow = false;
    // The client has no state that the next block's frame could be laid upon: at the beginning,
    // and when a frame could not be had. A whole state comes first then.
    bool needs_whole = false;
    // How often it is still waited for; see write_whole_of_block().
    static constexpr int kPausesMax = 20;
    int pauses_left = kPausesMax;
    std::uint64_t whole_seq = 0;  // what the whole state that was sent last includes
};

// Clients send nothing but control frames, which the library answers while a read is pending.
net::awaitable<void> read_until_closed(Session& session) {
    beast::flat_buffer buffer;
    auto [error, bytes] = co_await session.socket.async_read(buffer, kToken);
    if (!error) {
        session.closing = {websocket::close_code::policy_error, "clients send no messages"};
    } else if (error == websocket::error::message_too_big) {
        session.closing = {websocket::close_code::too_big, "message too big"};
    }
    session.peer_gone = true;
    session.cursor.wake();
}

net::awaitable<bool> write(Session& session, const std::string& bytes, bool binary) {
    session.socket.binary(binary);
    const auto begun = std::chrono::steady_clock::now();
    auto buffer = net::buffer(bytes);
    auto [error, count] = co_await session.socket.async_write(buffer, kToken);
    session.slow = session.slow || std::chrono::steady_clock::now() - begun > kSlowWrite;
    co_return !error && !session.peer_gone;
}

std::string patch_payload(const LiveJob& live, const Patch& patch, Partial partial) {
    if (partial == Partial::kLabels) {
        return proto::encode_labels(patch.labels);
    }
    // The region alone, in the whole model's frame.
    // Cells look the same whatever is around them; surfaces depend on it.
    std::vector<Label> labels(live.space().site_count(), kNoLabel);
    if (live.space().is_grid()) {
        live.space().copy_in(patch.labels, patch.region, labels);
    } else if (auto state = live.state_at(patch.seq)) {
        labels = std::move(state->model.labels);
    } else {
        return "";
    }
    return write_glb(live.space().make_scene(labels, patch.region)).value_or("");
}

// The frame of an accepted block; nothing when it is not kept any more.
std::optional<std::string> block_frame(
    JobService& service, const SocketUpgrade& upgrade, std::uint64_t seq
) {
    const auto live = service.live().find(upgrade.job_id);
    const auto patch = live ? live->patch(seq) : nullptr;
    if (!patch) {
        return std::nullopt;
    }
    const auto kind =
        upgrade.partial == Partial::kLabels ? proto::FrameKind::kLabels : proto::FrameKind::kGlb;
    return proto::encode_frame(
        {kind, seq, patch->region, patch_payload(*live, *patch, upgrade.partial)}
    );
}

struct WholeFrame {
    std::uint64_t seq = 0;
    std::string bytes;
};

enum class WholeIf : std::uint8_t { kAny, kAnyBlock };

std::optional<WholeFrame> whole_frame(
    JobService& service, const SocketUpgrade& upgrade, std::uint64_t seq, WholeIf condition
) {
    const auto whole = service.whole_state(upgrade.job_id, seq);
    if (!whole || (condition == WholeIf::kAnyBlock && !whole->any_block)) {
        return std::nullopt;
    }
    const Model& model = whole->model;
    const Box box = Box::whole(model.space->size());
    const bool labels = upgrade.partial == Partial::kLabels;
    const std::string payload =
        labels ? proto::encode_labels(model.labels) : write_glb(whole_scene(model)).value_or("");
    const auto kind = labels ? proto::FrameKind::kLabelsWhole : proto::FrameKind::kGlbWhole;
    return WholeFrame{whole->seq, proto::encode_frame({kind, whole->seq, box, payload})};
}

bool is_accepted_block(const Event& event) {
    return event.type == "block" &&
           event.fields.find("\"outcome\":\"accepted\"") != std::string::npos;
}

// Sends a whole state that includes everything up to `seq`, if there is one: a job that is solved
// again after a restart has none until it has come so far. False when the client is gone.
net::awaitable<bool> write_whole(
    Session& session, std::uint64_t seq, WholeIf condition = WholeIf::kAny
) {
    auto make = [&session, seq, condition] {
        return whole_frame(session.context.api->service(), session.upgrade, seq, condition);
    };
    const auto whole = co_await on_pool(*session.context.pool, make);
    if (!whole) {
        co_return true;
    }
    session.needs_whole = false;
    session.whole_seq = whole->seq;
    co_return co_await write(session, whole->bytes, true);
}

// The same for a block whose event was just read: it is on disk a moment before the live model has
// its labels, so that is waited for; but not long, since a job that is solved again after a restart
// takes its time to come so far.
net::awaitable<bool> write_whole_of_block(Session& session, std::uint64_t seq) {
    constexpr auto kPause = std::chrono::milliseconds(2);
    bool open = co_await write_whole(session, seq);
    while (open && session.needs_whole && session.pauses_left > 0) {
        --session.pauses_left;
        net::steady_timer timer(session.socket.get_executor(), kPause);
        co_await timer.async_wait(kToken);
        open = co_await write_whole(session, seq);
    }
    if (!session.needs_whole) {
        session.pauses_left = Session::kPausesMax;
    }
    co_return open;
}

net::awaitable<bool> write_event(Session& session, const Event& event) {
    const std::string text = proto::event_json(event.seq, event.type, event.time, event.fields);
    if (!co_await write(session, text, false)) {
        co_return false;
    }
    if (session.upgrade.partial == Partial::kNone) {
        co_return true;
    }
    if (event.type == "alternative" && event.seq > session.whole_seq) {
        session.needs_whole = true;  // the next model begins anew
    }
    if (!is_accepted_block(event)) {
        co_return true;
    }
    if (session.needs_whole) {  // then the block's frame is the whole state
        co_return co_await write_whole_of_block(session, event.seq);
    }
    if (event.seq <= session.whole_seq) {
        co_return true;  // included already
    }
    auto make = [&session, &event] {
        return block_frame(session.context.api->service(), session.upgrade, event.seq);
    };
    const auto frame = co_await on_pool(*session.context.pool, make);
    if (!frame) {
        session.needs_whole = true;
        co_return co_await write_whole_of_block(session, event.seq);
    }
    co_return co_await write(session, *frame, true);
}

// For a reader that lags: one snapshot in place of the events in between. Never in place of the
// last event: of an ended job it shows the state before the end.
net::awaitable<bool> write_snapshot(Session& session) {
    auto find = [&session] { return session.context.api->service().find(session.upgrade.job_id); };
    auto job = co_await on_pool(*session.context.pool, find);
    session.slow = false;
    if (!job) {
        co_return true;
    }
    if (proto::is_ended(job->state)) {
        --job->head;
        job->state = proto::JobState::kRunning;
        job->finished.reset();
        job->expires.reset();
        job->result.clear();
        job->error.clear();
    }
    if (job->head <= session.cursor.position() + kLagMax) {
        co_return true;
    }
    const std::string text = proto::event_json(
        job->head, "snapshot", proto::now_millis(), proto::snapshot_fields(proto::to_json(*job))
    );
    session.cursor.skip_to(job->head);
    session.needs_whole = session.upgrade.partial != Partial::kNone;
    co_return co_await write(session, text, false);
}

net::awaitable<void> write_events(Session& session) {
    constexpr auto kWait = std::chrono::milliseconds(500);
    constexpr auto kWaitForWhole = std::chrono::milliseconds(20);
    bool open = true;
    while (open && !session.peer_gone) {
        if (session.context.counters->draining) {
            session.closing = {websocket::close_code::going_away, "the server is stopping"};
            break;
        }
        const auto batch =
            co_await session.cursor.next(session.needs_whole ? kWaitForWhole : kWait);
        if (batch.gone) {
            session.closing = {websocket::close_code::going_away, "the job was deleted"};
            break;
        }
        for (const Event& event : batch.page.events) {
            const bool last = batch.finished && event.seq == batch.page.head;
            if (open && last && session.needs_whole) {
                open = co_await write_whole(session, event.seq - 1);
            }
            open = open && co_await write_event(session, event);
            if (open && session.slow) {
                session.cursor.skip_to(event.seq);
                open = co_await write_snapshot(session);
                break;
            }
        }
        if (batch.finished && session.cursor.position() >= batch.page.head) {
            session.closing = {websocket::close_code::normal, "the job has ended"};
            break;
        }
        if (open && session.needs_whole && batch.page.events.empty()) {
            // Before the first accepted block there is nothing to show; it brings the state itself.
            open = co_await write_whole(session, session.cursor.position(), WholeIf::kAnyBlock);
        }
    }
    if (session.closing.code != websocket::close_code::none) {
        auto reason = session.closing;
        co_await session.socket.async_close(reason, kToken);
    } else {
        beast::get_lowest_layer(session.socket).close();
    }
}

}  // namespace

net::awaitable<void> serve_websocket(
    beast::tcp_stream stream,
    beast::http::request<beast::http::string_body> request,
    SocketUpgrade upgrade,
    ConnectionContext context
) {
    using namespace net::experimental::awaitable_operators;
    stream.expires_never();  // the WebSocket keeps its own time
    Session session(std::move(stream), upgrade, context);
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.handshake_timeout = std::chrono::seconds(10);
    timeout.idle_timeout = std::chrono::seconds(kSocketIdleSeconds);
    timeout.keep_alive_pings = true;
    session.socket.set_option(timeout);
    auto decorate = [](websocket::response_type& response) {
        response.set(beast::http::field::sec_websocket_protocol, "modelsynth.v1");
        response.set(beast::http::field::server, "modelsynthd");
    };
    session.socket.set_option(websocket::stream_base::decorator(decorate));
    session.socket.read_message_max(kSocketMessageBytesMax);
    auto [error] = co_await session.socket.async_accept(request, kToken);
    if (error) {
        co_return;
    }
    co_await (read_until_closed(session) && write_events(session));
}

}  // namespace modelsynth::server
