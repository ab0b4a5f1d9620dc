#include "server/stream/job_feed.h"
#include "server/stream/stream_socket.h"
#include "server/stream/websocket.h"

#include <boost/asio/experimental/awaitable_operators.hpp>

#include <memory>
#include <utility>

namespace modelsynth::server {

namespace {

using CloseCode = StreamSocket::CloseCode;

// What the two halves of a session share.
struct JobSession {
    JobSession(Transport stream, JobStream wanted, const ConnectionContext& shared)
        : context(shared),
          socket(std::move(stream), context.limits),
          signal(std::make_shared<WakeSignal>(socket.executor())),
          feed(socket, context, signal, std::move(wanted), JobFeed::Naming::kNone) {}

    ConnectionContext context;
    StreamSocket socket;
    std::shared_ptr<WakeSignal> signal;
    JobFeed feed;
};

// Clients send nothing but control frames.
net::awaitable<void> refuse_messages(JobSession& session) {
    const auto message = co_await session.socket.read();
    if (message) {
        session.socket.close_with(CloseCode::policy_error, "clients send no messages");
    }
    session.signal->raise();
}

net::awaitable<void> write_events(JobSession& session) {
    constexpr std::size_t kPage = 256;
    StreamSocket& socket = session.socket;
    while (socket.is_open()) {
        const bool is_last_look = session.context.counters->draining;
        session.signal->lower();
        const auto turn = co_await session.feed.take_turn(kPage);
        if (turn == JobFeed::Turn::kEnded) {
            socket.close_with(CloseCode::normal, "the job has ended");
        } else if (turn == JobFeed::Turn::kDeleted) {
            socket.close_with(CloseCode::going_away, "the job was deleted");
        } else if (turn == JobFeed::Turn::kIdle && is_last_look) {
            socket.close_with(CloseCode::going_away, "the server is stopping");
        } else if (turn == JobFeed::Turn::kIdle && socket.is_open()) {
            co_await session.signal->wait_until(session.feed.due());
        }
    }
    co_await socket.finish();
}

}  // namespace

net::awaitable<void> serve_job_socket(
    Transport stream,
    boost::beast::http::request<boost::beast::http::string_body> request,
    JobStream wanted,
    ConnectionContext context
) {
    using namespace net::experimental::awaitable_operators;
    JobSession session(std::move(stream), std::move(wanted), context);
    if (co_await session.socket.accept(request)) {
        co_await (refuse_messages(session) && write_events(session) && session.socket.watch());
    }
}

}  // namespace modelsynth::server
