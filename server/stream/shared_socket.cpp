// One WebSocket for many jobs. The reader takes what the client asks for; the writer answers and
// lets the feeds take turns, so that a busy job keeps no other one waiting for more than a turn.
// Everything is sent by the writer: after an answer nothing comes that belongs before it.

#include "proto/stream_message.h"
#include "server/stream/job_feed.h"
#include "server/stream/on_pool.h"
#include "server/stream/stream_socket.h"
#include "server/stream/websocket.h"

#include <boost/asio/experimental/awaitable_operators.hpp>

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <variant>

namespace modelsynth::server {

namespace {

using CloseCode = StreamSocket::CloseCode;
using proto::StreamRequest;

// A request that the writer has to do, or the answer to one that was done.
using Pending = std::variant<StreamRequest, std::string>;

struct SharedSession {
    SharedSession(Transport stream, SocketUpgrade upgrade, const ConnectionContext& shared)
        : client(std::move(upgrade)),
          context(shared),
          socket(std::move(stream), context.limits),
          signal(std::make_shared<WakeSignal>(socket.executor())),
          room(socket.executor()) {}

    SocketUpgrade client;
    ConnectionContext context;
    StreamSocket socket;
    std::shared_ptr<WakeSignal> signal;          // there may be something to send
    WakeSignal room;                             // a pending request was done
    std::deque<Pending> pending;                 // at most stream_pending_max
    std::deque<std::unique_ptr<JobFeed>> feeds;  // whose turn is next first
};

std::string refuse(const StreamRequest& request, proto::Problem problem) {
    return proto::refusal_json({request.id, std::move(problem)});
}

// A refusal that points to a field.
std::string refuse(
    const StreamRequest& request, const char* kind, const char* pointer, const std::string& detail
) {
    proto::Problem problem = proto::make_problem(kind, detail);
    problem.errors.push_back({pointer, detail});
    return refuse(request, std::move(problem));
}

// Cancels at once: that never waits for what is being sent.
net::awaitable<std::string> cancel(SharedSession& session, const StreamRequest& request) {
    if (!session.client.may_cancel) {
        co_return refuse(
            request, proto::make_problem("missing-scope", "the key does not have the scope submit")
        );
    }
    auto work = [&session, &request] {
        JobService& service = session.context.api->service();
        auto job = service.find(request.job_id, session.client.caller);
        return job ? service.cancel(request.job_id) : job;
    };
    const auto job = co_await on_pool(*session.context.pool, work);
    if (!job) {
        co_return refuse(request, job.error());
    }
    co_return proto::cancelled_json(request, proto::state_name(job->state));
}

net::awaitable<Pending> take_in(SharedSession& session, const std::string& text) {
    auto request = proto::parse_stream_request(text);
    if (!request) {
        co_return proto::refusal_json(request.error());
    }
    if (request->type == proto::StreamRequestType::kCancel) {
        co_return co_await cancel(session, *request);
    }
    co_return std::move(*request);
}

net::awaitable<void> read_requests(SharedSession& session) {
    constexpr auto kWait = std::chrono::seconds(1);
    while (session.socket.is_open()) {
        session.room.lower();
        if (session.pending.size() >= session.context.limits.stream_pending_max) {
            co_await session.room.wait_until(WakeSignal::Clock::now() + kWait);
            continue;
        }
        const auto message = co_await session.socket.read();
        if (!message) {
            break;
        }
        if (!message->is_text) {
            session.socket.close_with(CloseCode::unknown_data, "messages are text");
            break;
        }
        auto pending = co_await take_in(session, message->bytes);
        session.pending.push_back(std::move(pending));
        session.signal->raise();
    }
    session.signal->raise();
}

auto find_feed(SharedSession& session, const std::string& job_id) {
    return std::find_if(session.feeds.begin(), session.feeds.end(), [&job_id](const auto& feed) {
        return feed->job_id() == job_id;
    });
}

// Why the request cannot be done, or nothing. Blocks.
std::optional<std::string> check_subscription(
    JobService& service, const Caller& caller, const StreamRequest& request, std::uint64_t& head
) {
    const auto job = service.find(request.job_id, caller);
    if (!job) {
        return refuse(request, job.error());
    }
    head = job->head;
    if (request.after > head) {
        return refuse(
            request,
            "invalid-request",
            "/after",
            "the log ends at " + std::to_string(head) + ", before " + std::to_string(request.after)
        );
    }
    if (request.partial == proto::Partial::kLabels && !solver_has_cells(job->solver)) {
        return refuse(
            request,
            "invalid-request",
            "/partial",
            "the job's model has no cells; \"partial\" may be glb"
        );
    }
    return std::nullopt;
}

net::awaitable<std::string> subscribe(SharedSession& session, const StreamRequest& request) {
    if (find_feed(session, request.job_id) != session.feeds.end()) {
        co_return refuse(request, "invalid-request", "/job", "the job is subscribed to already");
    }
    const std::size_t most = session.context.limits.stream_subscriptions_max;
    if (session.feeds.size() >= most) {
        co_return refuse(
            request,
            "too-large",
            "/job",
            "a connection follows at most " + std::to_string(most) +
                " jobs at once (stream_subscriptions_max)"
        );
    }
    std::uint64_t head = 0;
    auto check = [&session, &request, &head] {
        return check_subscription(
            session.context.api->service(), session.client.caller, request, head
        );
    };
    if (auto refusal = co_await on_pool(*session.context.pool, check)) {
        co_return std::move(*refusal);
    }
    JobStream wanted = {request.job_id, request.after, request.partial};
    session.feeds.push_back(std::make_unique<JobFeed>(
        session.socket, session.context, session.signal, std::move(wanted), JobFeed::Naming::kJobId
    ));
    co_return proto::subscribed_json(request, head);
}

std::string unsubscribe(SharedSession& session, const StreamRequest& request) {
    const auto feed = find_feed(session, request.job_id);
    if (feed == session.feeds.end()) {
        return refuse(request, "invalid-request", "/job", "the job is not subscribed to");
    }
    const std::uint64_t seq = (*feed)->position();
    session.feeds.erase(feed);
    return proto::unsubscribed_json(request, seq);
}

// Does what was asked for since and answers. Between two turns only.
net::awaitable<void> answer_pending(SharedSession& session) {
    while (!session.pending.empty() && session.socket.is_open()) {
        const Pending pending = std::move(session.pending.front());
        session.pending.pop_front();
        session.room.raise();
        std::string answer;
        if (const auto* request = std::get_if<StreamRequest>(&pending)) {
            if (request->type == proto::StreamRequestType::kSubscribe) {
                answer = co_await subscribe(session, *request);
            } else {
                answer = unsubscribe(session, *request);
            }
        } else {
            answer = std::get<std::string>(pending);
        }
        co_await session.socket.write_text(answer);
    }
}

// Gives the first feed its turn and puts it last, or ends it. True: it may have more to send.
net::awaitable<bool> take_turn(SharedSession& session) {
    constexpr std::size_t kEventsMax = 16;
    auto feed = std::move(session.feeds.front());
    session.feeds.pop_front();
    if (!feed->is_due(WakeSignal::Clock::now())) {
        session.feeds.push_back(std::move(feed));
        co_return false;
    }
    const auto turn = co_await feed->take_turn(kEventsMax);
    if (turn == JobFeed::Turn::kEnded || turn == JobFeed::Turn::kDeleted) {
        const auto reason = turn == JobFeed::Turn::kEnded ? proto::StreamEndReason::kEnded
                                                          : proto::StreamEndReason::kDeleted;
        const std::string end = proto::stream_end_json(feed->job_id(), reason, feed->position());
        co_return co_await session.socket.write_text(end);
    }
    session.feeds.push_back(std::move(feed));
    co_return turn == JobFeed::Turn::kBusy;
}

// When the first feed is due at the latest.
WakeSignal::Clock::time_point next_due(const SharedSession& session) {
    constexpr auto kWait = std::chrono::milliseconds(500);
    auto due = WakeSignal::Clock::now() + kWait;
    for (const auto& feed : session.feeds) {
        due = std::min(due, feed->due());
    }
    return due;
}

net::awaitable<void> write_messages(SharedSession& session) {
    StreamSocket& socket = session.socket;
    while (socket.is_open()) {
        const bool is_last_look = session.context.counters->draining;
        session.signal->lower();
        co_await answer_pending(session);
        bool busy = false;
        const std::size_t count = session.feeds.size();
        for (std::size_t i = 0; i < count && !session.feeds.empty() && socket.is_open(); ++i) {
            busy = co_await take_turn(session) || busy;
            co_await answer_pending(session);
        }
        if (!busy && is_last_look) {
            socket.close_with(CloseCode::going_away, "the server is stopping");
        } else if (!busy && socket.is_open()) {
            co_await session.signal->wait_until(next_due(session));
        }
    }
    co_await socket.finish();
}

}  // namespace

net::awaitable<void> serve_shared_socket(
    Transport stream,
    boost::beast::http::request<boost::beast::http::string_body> request,
    SocketUpgrade upgrade,
    ConnectionContext context
) {
    using namespace net::experimental::awaitable_operators;
    SharedSession session(std::move(stream), std::move(upgrade), context);
    if (co_await session.socket.accept(request)) {
        co_await (read_requests(session) && write_messages(session) && session.socket.watch());
    }
}

}  // namespace modelsynth::server
