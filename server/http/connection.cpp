#include "server/http/connection.h"

#include "proto/problem.h"
#include "server/http/access_log.h"
#include "server/http/correlation.h"
#include "server/http/head_check.h"
#include "server/http/transport.h"
#include "server/log/event_line.h"
#include "server/stream/event_cursor.h"
#include "server/stream/event_stream.h"
#include "server/stream/on_pool.h"
#include "server/stream/websocket.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>
#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using Parser = http::request_parser<http::string_body>;
using ErrorCode = boost::system::error_code;

constexpr auto kToken = net::as_tuple(net::use_awaitable);

// How a client begins that takes this port for one of TLS: a record of its handshake.
constexpr std::string_view kTlsHandshake = "\x16\x03";
// To one that takes a port of TLS for a plain one.
constexpr std::string_view kSpeakTls =
    "HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Type: text/plain\r\n"
    "Content-Length: 40\r\n\r\nThis port speaks HTTPS. Use https://...\n";

// One request as it comes in, and what becomes of the connection after it.
struct Exchange {
    Request request;
    unsigned version = 11;
    bool keep_alive = true;
    bool chunked = false;
    AnswerRecord answer;
};

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
          timer_(stream_.get_executor()),
          place_(place),
          context_(context) {
        buffer_.max_size(context.limits.head_bytes_max + kReadAhead);
    }

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
            co_await write_whole(busy, exchange);
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
            co_await stream_.end(std::chrono::seconds(1), !closed_);
        }
    }

  private:
    static constexpr std::size_t kReadAhead = 64 * 1024;

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
        Parser parser;
        auto refusal = co_await read_head(parser, exchange);
        if (closed_) {
            co_return false;
        }
        if (!refusal) {
            refusal = context_.api->check_head(exchange.request);
            if (refusal) {
                refusal->close = exchange.chunked || exchange.request.content_length > 0;
            }
        }
        if (!refusal) {
            refusal = co_await read_body(parser, exchange);
            if (closed_) {
                co_return false;
            }
        }
        if (refusal) {
            exchange.keep_alive = exchange.keep_alive && !refusal->close;
            co_return co_await write_whole(*refusal, exchange) && exchange.keep_alive;
        }
        auto handle = [this, &exchange] { return context_.api->handle(exchange.request); };
        Response response = co_await on_pool(*context_.pool, handle);
        exchange.answer.job_id = response.job_id;
        if (response.wait) {
            const bool left = co_await wait_for_job(*response.wait);
            if (left && response.wait->cancel_when_left) {
                co_await cancel(response.wait->job_id);
            }
            auto answer = [this, &exchange, &response] {
                return context_.api->answer_with_job(exchange.request, response, *response.wait);
            };
            Response answered = co_await on_pool(*context_.pool, answer);
            response = std::move(answered);
        }
        co_return co_await respond(std::move(response), exchange, parser);
    }

    static Response refusal_of(const proto::Problem& problem, const Exchange& exchange) {
        Response response = problem_response(problem, exchange.request);
        response.close = true;
        return response;
    }

    // Reads up to the empty line. A refusal, or nothing when the head is fine; closed_ is set
    // when there is nobody to answer.
    net::awaitable<std::optional<Response>> read_head(Parser& parser, Exchange& exchange) {
        if (buffer_.size() == 0) {
            const std::chrono::seconds idle(context_.limits.idle_seconds);
            if (co_await read_more(Clock::now() + idle)) {
                closed_ = true;
                co_return std::nullopt;
            }
        }
        exchange.answer.begun = Clock::now();
        const auto until =
            exchange.answer.begun + std::chrono::seconds(context_.limits.head_seconds);
        ErrorCode error;
        std::size_t head_end = find_head_end();
        while (head_end == std::string_view::npos && !error) {
            if (buffered().starts_with(kTlsHandshake)) {
                co_return refusal_of(
                    proto::make_problem("malformed-request", "this port speaks HTTP without TLS"),
                    exchange
                );
            }
            if (buffer_.size() > context_.limits.head_bytes_max) {
                error = http::error::header_limit;
                break;
            }
            error = co_await read_more(until);
            head_end = find_head_end();
        }
        const std::string_view bytes = buffered();
        const std::size_t head_bytes = head_end;
        if (error == beast::error::timeout) {
            co_return refusal_of(
                proto::plain_problem(408, "the head of the request did not come in time"), exchange
            );
        }
        const std::size_t line_bytes = std::min(bytes.find("\r\n"), bytes.size());
        if (line_bytes > context_.limits.target_bytes_max) {
            co_return refusal_of(
                proto::plain_problem(
                    414,
                    "the request line may have " +
                        std::to_string(context_.limits.target_bytes_max) + " bytes"
                ),
                exchange
            );
        }
        if (error == http::error::header_limit ||
            (!error && head_bytes > context_.limits.head_bytes_max)) {
            co_return too_many_fields(exchange);
        }
        if (error) {
            closed_ = true;
            co_return std::nullopt;
        }
        if (const auto problem = check_raw_head(bytes.substr(0, head_bytes))) {
            co_return refusal_of(*problem, exchange);
        }
        co_return parse_head(parser, exchange);
    }

    using Clock = std::chrono::steady_clock;

    [[nodiscard]] std::string_view buffered() const {
        return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
    }

    // Where the head ends that the buffer begins with, empty lines before it left out (RFC 9112
    // 2.2 wants them ignored); npos when its end has not come yet.
    std::size_t find_head_end() {
        while (buffered().starts_with("\r\n")) {
            buffer_.consume(2);
        }
        const std::size_t end = buffered().find("\r\n\r\n");
        return end == std::string_view::npos ? end : end + 4;
    }

    // Reads what comes next into the buffer; beast::error::timeout when nothing came in time.
    // The stream's own timeout would close the socket, and the client would get no answer.
    net::awaitable<ErrorCode> read_more(Clock::time_point until) {
        using namespace net::experimental::awaitable_operators;
        constexpr std::size_t kPiece = 16 * 1024;
        auto space = buffer_.prepare(kPiece);
        stream_.expires_never();
        timer_.expires_at(until);
        auto outcome =
            co_await (stream_.async_read_some(space, kToken) || timer_.async_wait(kToken));
        if (outcome.index() == 1) {
            co_return ErrorCode(beast::error::timeout);
        }
        const auto [error, count] = std::get<0>(outcome);
        buffer_.commit(count);
        co_return error;
    }

    Response too_many_fields(const Exchange& exchange) const {
        return refusal_of(
            proto::plain_problem(
                431,
                "the header fields may have " + std::to_string(context_.limits.head_bytes_max) +
                    " bytes and be " + std::to_string(context_.limits.fields_max)
            ),
            exchange
        );
    }

    std::optional<Response> parse_head(Parser& parser, Exchange& exchange) {
        parser.header_limit(static_cast<std::uint32_t>(context_.limits.head_bytes_max + 1));
        parser.body_limit(boost::none);  // check_head() knows what the resource takes
        ErrorCode error;
        const std::size_t used = parser.put(buffer_.data(), error);
        buffer_.consume(used);
        if (error == http::error::header_limit) {
            return too_many_fields(exchange);
        }
        if (error == http::error::bad_version) {
            // The library says the same of a bare line feed, which is another fault.
            return refusal_of(
                proto::plain_problem(505, "this server speaks HTTP/1.1 and HTTP/1.0"), exchange
            );
        }
        if ((error && error != http::error::need_more) || !parser.is_header_done()) {
            return refusal_of(
                proto::make_problem("malformed-request", "the head of the request is malformed"),
                exchange
            );
        }
        const auto& message = parser.get();
        exchange.version = message.version();
        exchange.keep_alive = message.keep_alive();
        exchange.chunked = parser.chunked();
        exchange.request.method = std::string(message.method_string());
        exchange.request.content_length = parser.content_length().value_or(0);
        for (const auto& field : message) {
            std::string name(field.name_string());
            std::transform(name.begin(), name.end(), name.begin(), [](char c) {
                return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
            });
            exchange.request.headers.emplace_back(std::move(name), std::string(field.value()));
        }
        take_correlation(exchange.request);
        if (exchange.request.headers.size() > context_.limits.fields_max) {
            return too_many_fields(exchange);
        }
        if (!parse_target(std::string_view(message.target()), exchange.request)) {
            return refusal_of(
                proto::make_problem("malformed-request", "the target of the request is malformed"),
                exchange
            );
        }
        if (const auto problem = check_framing(exchange.request, exchange.version)) {
            return refusal_of(*problem, exchange);
        }
        return std::nullopt;
    }

    net::awaitable<std::optional<Response>> read_body(Parser& parser, Exchange& exchange) {
        const std::uint64_t limit = context_.api->body_bytes_max(exchange.request);
        parser.body_limit(limit);
        if (!parser.is_done()) {
            if (exchange.version >= 11 && exchange.request.header("expect")) {
                static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
                auto bytes = net::buffer(kContinue);
                co_await net::async_write(stream_, bytes, kToken);
            }
            parser.eager(true);
            const ErrorCode error = co_await read_into(parser);
            if (error == http::error::body_limit) {
                co_return refusal_of(
                    proto::make_problem(
                        "body-too-large", "the body may have " + std::to_string(limit) + " bytes"
                    ),
                    exchange
                );
            }
            if (error == beast::error::timeout) {
                co_return refusal_of(
                    proto::plain_problem(408, "the body did not come in time"), exchange
                );
            }
            if (error.category() == make_error_code(http::error::bad_chunk).category() &&
                error != http::error::partial_message && error != http::error::end_of_stream) {
                co_return refusal_of(
                    proto::make_problem("malformed-request", "the body is malformed"), exchange
                );
            }
            if (error) {
                closed_ = true;
                co_return std::nullopt;
            }
        }
        exchange.request.body = std::move(parser.get().body());
        co_return std::nullopt;
    }

    net::awaitable<ErrorCode> read_into(Parser& parser) {
        using namespace net::experimental::awaitable_operators;
        stream_.expires_never();
        timer_.expires_after(std::chrono::seconds(context_.limits.body_seconds));
        auto outcome = co_await (
            http::async_read(stream_, buffer_, parser, kToken) || timer_.async_wait(kToken)
        );
        if (outcome.index() == 1) {
            co_return ErrorCode(beast::error::timeout);
        }
        co_return std::get<0>(std::get<0>(outcome));
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
        EventCursor cursor(events(), wait.job_id, wait.since.value_or(0));
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
            const auto batch = co_await cursor.next(std::min(left, kSlice));
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

    net::awaitable<bool> respond(Response response, Exchange& exchange, Parser& parser) {
        if (!std::holds_alternative<std::string>(response.body) &&
            !std::holds_alternative<FileBody>(response.body)) {
            // No request comes after it, and a stream may be silent for days.
            buffer_.clear();
            buffer_.shrink_to_fit();
        }
        if (auto* upgrade = std::get_if<SocketUpgrade>(&response.body)) {
            handed_over_ = true;
            exchange.answer.status = response.status;
            exchange.answer.is_stream = true;
            auto handshake = parser.release();
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
            co_return co_await write_file(response, exchange) && exchange.keep_alive;
        }
        co_return co_await write_whole(response, exchange) && exchange.keep_alive;
    }

    static std::string head_text(
        const Response& response, Exchange& exchange, std::optional<std::uint64_t> length
    ) {
        exchange.answer.status = response.status;
        exchange.answer.problem = response.problem;
        std::string text =
            "HTTP/1.1 " + std::to_string(response.status) + " " +
            std::string(http::obsolete_reason(static_cast<http::status>(response.status))) + "\r\n";
        std::string vary;
        const Fields& answer_fields = exchange.request.answer_fields;
        for (const Fields* fields : {&response.headers, &answer_fields}) {
            for (const auto& [name, value] : *fields) {
                if (name == "Vary") {
                    vary += (vary.empty() ? "" : ", ") + value;
                } else {
                    text += name + ": " + value + "\r\n";
                }
            }
        }
        text += vary.empty() ? "" : "Vary: " + vary + "\r\n";
        text += "X-Request-Id: " + exchange.request.id +
                "\r\nServer: modelsynthd\r\nX-Content-Type-Options: nosniff\r\n";
        if (length) {
            text += "Content-Length: " + std::to_string(*length) + "\r\n";
        }
        if (!exchange.keep_alive) {
            text += "Connection: close\r\n";
        } else if (exchange.version < 11) {
            text += "Connection: keep-alive\r\n";
        }
        return text + "\r\n";
    }

    net::awaitable<bool> write_bytes(std::string_view bytes, Exchange& exchange) {
        stream_.expires_after(std::chrono::seconds(context_.limits.write_seconds));
        auto buffer = net::buffer(bytes.data(), bytes.size());
        auto [error, count] = co_await net::async_write(stream_, buffer, kToken);
        exchange.answer.bytes += count;
        closed_ = closed_ || error;
        co_return !error;
    }

    net::awaitable<bool> write_whole(const Response& response, Exchange& exchange) {
        const auto& body = std::get<std::string>(response.body);
        // 204 and 304 have no content, not even an empty one.
        const bool has_content = response.status != 204 && response.status != 304;
        const auto length = has_content ? std::optional<std::uint64_t>(body.size()) : std::nullopt;
        std::string text = head_text(response, exchange, length);
        if (has_content && exchange.request.method != "HEAD") {
            text += body;
        }
        co_return co_await write_bytes(text, exchange);
    }

    net::awaitable<bool> write_file(const Response& response, Exchange& exchange) {
        constexpr std::uint64_t kPiece = 256 * 1024;
        FileBody body = std::get<FileBody>(response.body);
        const std::string head = head_text(response, exchange, body.length);
        if (!co_await write_bytes(head, exchange) || exchange.request.method == "HEAD") {
            co_return !closed_;
        }
        std::string piece;
        while (body.length > 0) {
            piece.resize(std::min(kPiece, body.length));
            auto read = [&body, &piece] { return body.reader->read(body.offset, piece); };
            const auto got = co_await on_pool(*context_.pool, read);
            if (!got || !co_await write_bytes(piece, exchange)) {
                closed_ = true;  // a length was promised that cannot be kept
                co_return false;
            }
            body.offset += piece.size();
            body.length -= piece.size();
        }
        co_return true;
    }

    // Text as a chunk, or as it is for HTTP/1.0, whose stream ends with the connection.
    net::awaitable<bool> write_chunk(std::string text, Exchange& exchange) {
        if (exchange.version >= 11) {
            std::array<char, 20> size = {};
            const int digits = std::snprintf(size.data(), size.size(), "%zx\r\n", text.size());
            text = std::string(size.data(), static_cast<std::size_t>(digits)) + text + "\r\n";
        }
        co_return co_await write_bytes(text, exchange);
    }

    // The connection as the place where an event stream goes.
    class Sink final : public EventSink {
      public:
        Sink(Connection& connection, Exchange& exchange)
            : connection_(connection), exchange_(exchange) {}

        net::awaitable<bool> write(std::string text) override {
            return connection_.write_chunk(std::move(text), exchange_);
        }

        bool has_gone() override {
            connection_.closed_ = connection_.closed_ || connection_.peer_has_closed();
            return connection_.closed_;
        }

      private:
        Connection& connection_;
        Exchange& exchange_;
    };

    net::awaitable<void> write_events(
        Response& response, const EventStreamBody& body, Exchange& exchange
    ) {
        exchange.keep_alive = false;
        exchange.answer.is_stream = true;
        if (exchange.version >= 11) {
            response.headers.emplace_back("Transfer-Encoding", "chunked");
        }
        ErrorCode ignored;
        stream_.socket().set_option(
            net::socket_base::send_buffer_size(context_.limits.stream_send_buffer_bytes), ignored
        );
        const std::string head = head_text(response, exchange, std::nullopt);
        const bool open = co_await write_bytes(head, exchange);
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
        if (ended && exchange.version >= 11) {
            static constexpr std::string_view kLastChunk = "0\r\n\r\n";
            co_await write_bytes(kLastChunk, exchange);
        }
        if (!ended && body.cancel_when_left) {
            co_await cancel(body.job_id);
        }
    }

    Transport stream_;
    net::steady_timer timer_;
    const OpenConnections::Place& place_;
    const ConnectionContext& context_;
    beast::flat_buffer buffer_;
    bool closed_ = false;       // nobody reads any more
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
