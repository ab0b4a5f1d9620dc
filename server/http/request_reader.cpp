#include "server/http/request_reader.h"

#include "proto/problem.h"
#include "server/http/correlation.h"
#include "server/http/head_check.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace modelsynth::server {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr auto kReadToken = net::as_tuple(net::use_awaitable);
constexpr std::size_t kReadAhead = 64 * 1024;

// How a client begins that takes this port for one of TLS: a record of its handshake.
constexpr std::string_view kTlsHandshake = "\x16\x03";

Response refusal_of(const proto::Problem& problem, const Exchange& exchange) {
    Response response = problem_response(problem, exchange.request);
    response.close = true;
    return response;
}

}  // namespace

RequestReader::RequestReader(Transport& stream, const ConnectionContext& context)
    : stream_(stream), context_(context), timer_(stream.get_executor()) {
    buffer_.max_size(context.limits.head_bytes_max + kReadAhead);
}

net::awaitable<std::optional<Response>> RequestReader::read(Exchange& exchange) {
    parser_.emplace();
    auto refusal = co_await read_head(exchange);
    if (ended_) {
        co_return std::nullopt;
    }
    if (!refusal) {
        refusal = context_.api->check_head(exchange.request);
        if (refusal) {
            refusal->close = exchange.chunked || exchange.request.content_length > 0;
        }
    }
    if (!refusal) {
        refusal = co_await read_body(exchange);
    }
    co_return refusal;
}

void RequestReader::close() {
    buffer_.clear();
    buffer_.shrink_to_fit();
}

// Reads up to the empty line. A refusal, or nothing when the head is fine; closed_ is set
// when there is nobody to answer.
net::awaitable<std::optional<Response>> RequestReader::read_head(Exchange& exchange) {
    if (buffer_.size() == 0) {
        const std::chrono::seconds idle(context_.limits.idle_seconds);
        if (co_await read_more(Clock::now() + idle)) {
            ended_ = true;
            co_return std::nullopt;
        }
    }
    exchange.answer.begun = Clock::now();
    const auto until = exchange.answer.begun + std::chrono::seconds(context_.limits.head_seconds);
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
                "the request line may have " + std::to_string(context_.limits.target_bytes_max) +
                    " bytes"
            ),
            exchange
        );
    }
    if (error == http::error::header_limit ||
        (!error && head_bytes > context_.limits.head_bytes_max)) {
        co_return too_many_fields(exchange);
    }
    if (error) {
        ended_ = true;
        co_return std::nullopt;
    }
    if (const auto problem = check_raw_head(bytes.substr(0, head_bytes))) {
        co_return refusal_of(*problem, exchange);
    }
    co_return parse_head(exchange);
}

std::string_view RequestReader::buffered() const {
    return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
}

// Where the head ends that the buffer begins with, empty lines before it left out (RFC 9112
// 2.2 wants them ignored); npos when its end has not come yet.
std::size_t RequestReader::find_head_end() {
    while (buffered().starts_with("\r\n")) {
        buffer_.consume(2);
    }
    const std::size_t end = buffered().find("\r\n\r\n");
    return end == std::string_view::npos ? end : end + 4;
}

// Reads what comes next into the buffer; beast::error::timeout when nothing came in time.
// The stream's own timeout would close the socket, and the client would get no answer.
net::awaitable<RequestReader::ErrorCode> RequestReader::read_more(Clock::time_point until) {
    using namespace net::experimental::awaitable_operators;
    constexpr std::size_t kPiece = 16 * 1024;
    auto space = buffer_.prepare(kPiece);
    stream_.expires_never();
    timer_.expires_at(until);
    auto outcome =
        co_await (stream_.async_read_some(space, kReadToken) || timer_.async_wait(kReadToken));
    if (outcome.index() == 1) {
        co_return ErrorCode(beast::error::timeout);
    }
    const auto [error, count] = std::get<0>(outcome);
    buffer_.commit(count);
    co_return error;
}

Response RequestReader::too_many_fields(const Exchange& exchange) const {
    return refusal_of(
        proto::plain_problem(
            431,
            "the header fields may have " + std::to_string(context_.limits.head_bytes_max) +
                " bytes and be " + std::to_string(context_.limits.fields_max)
        ),
        exchange
    );
}

std::optional<Response> RequestReader::parse_head(Exchange& exchange) {
    parser_->header_limit(static_cast<std::uint32_t>(context_.limits.head_bytes_max + 1));
    parser_->body_limit(boost::none);  // check_head() knows what the resource takes
    ErrorCode error;
    const std::size_t used = parser_->put(buffer_.data(), error);
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
    if ((error && error != http::error::need_more) || !parser_->is_header_done()) {
        return refusal_of(
            proto::make_problem("malformed-request", "the head of the request is malformed"),
            exchange
        );
    }
    const auto& message = parser_->get();
    exchange.version = message.version();
    exchange.keep_alive = message.keep_alive();
    exchange.chunked = parser_->chunked();
    exchange.request.method = std::string(message.method_string());
    exchange.request.content_length = parser_->content_length().value_or(0);
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

net::awaitable<std::optional<Response>> RequestReader::read_body(Exchange& exchange) {
    const std::uint64_t limit = context_.api->body_bytes_max(exchange.request);
    parser_->body_limit(limit);
    if (!parser_->is_done()) {
        if (exchange.version >= 11 && exchange.request.header("expect")) {
            static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
            auto bytes = net::buffer(kContinue);
            co_await net::async_write(stream_, bytes, kReadToken);
        }
        parser_->eager(true);
        const ErrorCode error = co_await read_rest();
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
            ended_ = true;
            co_return std::nullopt;
        }
    }
    exchange.request.body = std::move(parser_->get().body());
    co_return std::nullopt;
}

net::awaitable<RequestReader::ErrorCode> RequestReader::read_rest() {
    using namespace net::experimental::awaitable_operators;
    stream_.expires_never();
    timer_.expires_after(std::chrono::seconds(context_.limits.body_seconds));
    auto outcome = co_await (
        http::async_read(stream_, buffer_, *parser_, kReadToken) || timer_.async_wait(kReadToken)
    );
    if (outcome.index() == 1) {
        co_return ErrorCode(beast::error::timeout);
    }
    co_return std::get<0>(std::get<0>(outcome));
}

}  // namespace modelsynth::server
