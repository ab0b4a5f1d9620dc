#include "server/http/connection.h"

#include "proto/problem.h"
#include "server/http/answer_writer.h"
#include "server/http/correlation.h"
#include "server/http/excuse.h"
#include "server/http/request_reader.h"
#include "server/http/transport.h"
#include "server/log/event_line.h"
#include "server/stream/event_cursor.h"
#include "server/stream/event_stream.h"
#include "server/stream/on_pool.h"
#include "server/stream/websocket.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace modelsynth::server {

namespace {

using ErrorCode = boost::system::error_code;

// To one that takes a port of TLS for a plain one.
constexpr std::string_view kSpeakTls =
    "HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Type: text/plain\r\n"
    "Content-Length: 40\r\n\r\nThis port speaks HTTPS. Use https://...\n";

// Tells the observer that there is one more of something, as long as it lives.
class Notice {
  public:
    Notice(HttpObserver& observer, void (HttpObserver::*tell)(int))
        : observer_(observer), tell_(tell) {
        (observer_.*tell_)(1);
    }

    Notice(const Notice&) = delete;
    Notice& operator=(const Notice&) = delete;

    ~Notice() { (observer_.*tell_)(-1); }

  private:
    HttpObserver& observer_;
    void (HttpObserver::*tell_)(int);
};

class Connection {
  public:
    Connection(
        Transport stream, const OpenConnections::Place& place, const ConnectionContext& context
    )
        : stream_(std::move(stream)),
          reader_(stream_, context),
          writer_(stream_, *context.pool, std::chrono::seconds(context.limits.write_seconds)),
          place_(place),
          context_(context) {}

    net::awaitable<void> serve() {
        ErrorCode ignored;
        stream_.socket().set_option(net::ip::tcp::no_delay(true), ignored);
        if (context_.tls->is_on() && !co_await shake_hands()) {
            co_return;
        }
        if (const char* reason = refusal_reason()) {
            context_.observer->on_connection_refused(reason);
            const Response busy = problem_response(
                proto::make_problem("unavailable", "too many connections are open"), {}
            );
            Exchange exchange;
            exchange.request.id = make_request_id();
            exchange.keep_alive = false;
            static_cast<void>(co_await writer_.write_whole(busy, exchange));
            co_return;
        }
        for (std::uint32_t count = 0; count < context_.limits.requests_per_connection_max;
             ++count) {
            if (!co_await serve_one()) {
                break;
            }
        }
        if (!handed_over_) {
            // Lets the client read the answer before bytes that nobody read reset the connection.
            co_await stream_.end(std::chrono::seconds(1), !has_gone());
        }
    }

  private:
    // The beginning of TLS; false when there is nobody to serve. What is too much gets no answer,
    // since that would cost a handshake.
    net::awaitable<bool> shake_hands() {
        if (const char* reason = refusal_reason()) {
            context_.observer->on_connection_refused(reason);
            co_return false;
        }
        const auto error =
            co_await stream_.shake_hands(std::chrono::seconds(context_.limits.head_seconds));
        if (error) {
            const std::string why = error.message();
            log_event(*context_.log, spdlog::level::debug, "no TLS with a client", {{"why", why}});
        }
        if (is_plain_http(error)) {
            co_await stream_.write_raw(kSpeakTls);
            co_await stream_.end(std::chrono::seconds(1), true);
        }
        co_return !error;
    }

    // Why there is no room for this connection, or null.
    [[nodiscard]] const char* refusal_reason() const {
        if (place_.count() > context_.limits.connections_max) {
            return "connections";
        }
        const std::size_t of_address_max = context_.limits.connections_per_address_max;
        return of_address_max > 0 && place_.count_of_address() > of_address_max
                   ? "connections-of-address"
                   : nullptr;
    }

    // Serves one request; false when the connection is done with.
    net::awaitable<bool> serve_one() {
        Exchange exchange;
        exchange.request.id = make_request_id();
        const bool goes_on = co_await answer_one(exchange);
        if (exchange.answer.status != 0) {
            report_answer(exchange.request, exchange.answer, context_);
        }
        co_return goes_on;
    }

    net::awaitable<bool> answer_one(Exchange& exchange) {
        const auto refusal = co_await reader_.read(exchange);
        if (reader_.has_ended()) {
            co_return false;
        }
        if (refusal) {
            exchange.keep_alive = exchange.keep_alive && !refusal->close;
            co_return co_await writer_.write_whole(*refusal, exchange) && exchange.keep_alive;
        }
        auto handle = [this, &exchange] {
            return answer_or_excuse(exchange.request, *context_.log, [&] {
                return context_.api->handle(exchange.request);
            });
        };
        Response response = co_await on_pool(*context_.pool, handle);
        exchange.answer.job_id = response.job_id;
        if (response.wait) {
            const bool left = co_await wait_for_job(*response.wait);
            if (left && response.wait->cancel_when_left) {
                co_await cancel(response.wait->job_id);
            }
            auto answer = [this, &exchange, &response] {
                return answer_or_excuse(exchange.request, *context_.log, [&] {
                    return context_.api->answer_with_job(
                        exchange.request, response, *response.wait
                    );
                });
            };
            Response answered = co_await on_pool(*context_.pool, answer);
            response = std::move(answered);
        }
        co_return co_await respond(std::move(response), exchange);
    }

    // The job of a client that went away and was the only one who wanted it.
    net::awaitable<void> cancel(const std::string job_id) {
        auto work = [this, &job_id] { return context_.api->service().cancel(job_id); };
        const auto cancelled = co_await on_pool(*context_.pool, work);
        if (cancelled) {
            log_event(
                *context_.log,
                spdlog::level::info,
                "job cancelled as its client left",
                {{"job", job_id}}
            );
        }
    }

    EventCursor::Source events() {
        return {&context_.api->service().events(), context_.pool, stream_.get_executor()};
    }

    // Waits until the job ended, or has the event that is waited for, the time is up or the client
    // is gone; true: it is gone.
    net::awaitable<bool> wait_for_job(const WaitForJob wait) {
        std::optional<EventCursor> cursor;
        if (wait.since) {
            cursor.emplace(events(), wait.job_id, *wait.since);
        } else {
            cursor.emplace(events(), wait.job_id);
        }
        const auto until = std::chrono::steady_clock::now() + wait.most;
        stream_.expires_never();
        for (;;) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                until - std::chrono::steady_clock::now()
            );
            if (context_.counters->draining) {
                co_return false;
            }
            if (peer_has_closed()) {
                co_return true;
            }
            if (left.count() <= 0) {
                co_return false;
            }
            constexpr auto kSlice = std::chrono::milliseconds(500);
            const auto batch = co_await cursor->next(std::min(left, kSlice));
            const bool has_news = wait.since && !batch.page.events.empty();
            if (batch.gone || batch.finished || has_news) {
                co_return false;
            }
        }
    }

    // Looks without reading: bytes of a next request may be there, before the end too. A client
    // that only stops sending cannot be told from one that has gone, and counts as gone; one that
    // says within TLS that it stops sending is still there.
    bool peer_has_closed() {
        pollfd state = {stream_.socket().native_handle(), POLLRDHUP, 0};
        return ::poll(&state, 1, 0) > 0;
    }

    net::awaitable<bool> respond(Response response, Exchange& exchange) {
        if (!std::holds_alternative<std::string>(response.body) &&
            !std::holds_alternative<FileBody>(response.body)) {
            // No request comes after it, and a stream may be silent for days.
            reader_.close();
        }
        if (auto* upgrade = std::get_if<SocketUpgrade>(&response.body)) {
            handed_over_ = true;
            exchange.answer.status = response.status;
            exchange.answer.is_stream = true;
            auto handshake = reader_.release();
            handshake.set("X-Request-Id", exchange.request.id);  // as the answer tells it
            const Notice notice(*context_.observer, &HttpObserver::on_websockets);
            if (upgrade->job) {
                auto session = serve_job_socket(
                    std::move(stream_), std::move(handshake), std::move(*upgrade->job), context_
                );
                co_await std::move(session);
            } else {
                auto session = serve_shared_socket(
                    std::move(stream_), std::move(handshake), std::move(*upgrade), context_
                );
                co_await std::move(session);
            }
            co_return false;
        }
        if (auto* events = std::get_if<EventStreamBody>(&response.body)) {
            co_await write_events(response, *events, exchange);
            co_return false;
        }
        exchange.keep_alive =
            exchange.keep_alive && !response.close && !context_.counters->stopping;
        if (std::holds_alternative<FileBody>(response.body)) {
            co_return co_await writer_.write_file(response, exchange) && exchange.keep_alive;
        }
        co_return co_await writer_.write_whole(response, exchange) && exchange.keep_alive;
    }

    // The connection as the place where an event stream goes.
    class Sink final : public EventSink {
      public:
        Sink(Connection& connection, Exchange& exchange)
            : connection_(connection), exchange_(exchange) {}

        net::awaitable<bool> write(std::string text) override {
            return connection_.writer_.write_chunk(std::move(text), exchange_);
        }

        bool has_gone() override { return connection_.has_gone() || connection_.peer_has_closed(); }

      private:
        Connection& connection_;
        Exchange& exchange_;
    };

    net::awaitable<void> write_events(
        Response& response, const EventStreamBody& body, Exchange& exchange
    ) {
        ErrorCode ignored;
        stream_.socket().set_option(
            net::socket_base::send_buffer_size(context_.limits.stream_send_buffer_bytes), ignored
        );
        const bool open = co_await writer_.begin_stream(response, exchange);
        if (exchange.request.method == "HEAD") {
            co_return;
        }
        EventCursor cursor(events(), body.job_id, body.after);
        Sink sink(*this, exchange);
        const EventStreamContext context = {
            &context_.api->service(),
            context_.pool,
            &context_.counters->draining,
            std::chrono::seconds(context_.limits.stream_idle_seconds) / 4,
            context_.observer};
        const bool ended = open && co_await write_event_stream(sink, cursor, context);
        if (ended) {
            static_cast<void>(co_await writer_.end_stream(exchange));
        }
        if (!ended && body.cancel_when_left) {
            co_await cancel(body.job_id);
        }
    }

    // Nobody reads any more.
    [[nodiscard]] bool has_gone() const { return reader_.has_ended() || writer_.has_failed(); }

    Transport stream_;
    RequestReader reader_;
    AnswerWriter writer_;
    const OpenConnections::Place& place_;
    const ConnectionContext& context_;
    bool handed_over_ = false;  // the stream is a WebSocket's
};

}  // namespace

net::awaitable<void> serve_connection(net::ip::tcp::socket socket, ConnectionContext context) {
    ErrorCode error;
    const auto peer = socket.remote_endpoint(error);  // fails when the client has gone already
    const OpenConnections::Place place(context.counters->open, peer.address());
    const Notice notice(*context.observer, &HttpObserver::on_connections);
    const auto tls = context.tls->context();
    Transport stream = tls ? Transport(std::move(socket), *tls) : Transport(std::move(socket));
    Connection connection(std::move(stream), place, context);
    co_await connection.serve();
}

}  // namespace modelsynth::server
