#include "server/stream/stream_socket.h"

#include "proto/stream_message.h"
#include "proto/timestamp.h"
#include "server/stream/snapshot.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace modelsynth::server {

namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr auto kSocketToken = net::as_tuple(net::use_awaitable);

// A message goes out in fragments of this size, so that progress is seen and a close frame need not
// wait for its end.
constexpr std::size_t kPieceBytes = 64 * 1024;
// For a client that took nothing for too long to still learn why it is closed.
constexpr auto kStallGrace = std::chrono::seconds(10);
constexpr auto kWatchInterval = std::chrono::seconds(1);

}  // namespace

StreamSocket::StreamSocket(Transport stream, const HttpLimits& limits)
    : socket_(std::move(stream)),
      finished_signal_(socket_.get_executor()),
      stall_max_(limits.write_seconds) {
    Transport& transport = socket_.next_layer();
    transport.expires_never();  // the WebSocket keeps its own time
    boost::system::error_code ignored;
    transport.socket().set_option(
        net::socket_base::send_buffer_size(limits.stream_send_buffer_bytes), ignored
    );
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.handshake_timeout = std::chrono::seconds(10);
    timeout.idle_timeout = std::chrono::seconds(limits.stream_idle_seconds);
    timeout.keep_alive_pings = true;
    socket_.set_option(timeout);
    socket_.read_message_max(proto::kStreamMessageBytesMax);
    socket_.auto_fragment(false);
}

net::awaitable<bool> StreamSocket::accept(
    const beast::http::request<beast::http::string_body>& request
) {
    auto decorate = [id =
                         std::string(request["X-Request-Id"])](websocket::response_type& response) {
        response.set(beast::http::field::sec_websocket_protocol, "modelsynth.v1");
        response.set(beast::http::field::server, "modelsynthd");
        response.set("X-Request-Id", id);
        response.set(beast::http::field::date, proto::to_http_date(proto::now_millis()));
    };
    socket_.set_option(websocket::stream_base::decorator(std::move(decorate)));
    auto [error] = co_await socket_.async_accept(request, kSocketToken);
    co_return !error;
}

net::awaitable<std::optional<StreamSocket::Message>> StreamSocket::read() {
    beast::flat_buffer buffer;
    auto [error, bytes] = co_await socket_.async_read(buffer, kSocketToken);
    if (!error) {
        Message message;
        message.bytes = beast::buffers_to_string(buffer.data());
        message.is_text = socket_.got_text();
        co_return message;
    }
    if (error == websocket::error::message_too_big) {
        close_with(CloseCode::too_big, "message too big");
    }
    peer_gone_ = true;
    co_return std::nullopt;
}

net::awaitable<bool> StreamSocket::write_text(std::string_view text) {
    return write(false, {}, text);
}

net::awaitable<bool> StreamSocket::write_binary(std::string_view head, std::string_view payload) {
    return write(true, head, payload);
}

net::awaitable<bool> StreamSocket::write(
    bool is_binary, std::string_view head, std::string_view payload
) {
    socket_.binary(is_binary);
    const auto begun = Clock::now();
    bool is_last = false;
    while (!is_last && is_open()) {
        const std::string_view piece = payload.substr(0, kPieceBytes);
        payload.remove_prefix(piece.size());
        is_last = payload.empty();
        const std::array<net::const_buffer, 2> buffers = {
            net::const_buffer(head.data(), head.size()),
            net::const_buffer(piece.data(), piece.size())};
        head = {};
        writing_since_ = Clock::now();
        auto [error, count] = co_await socket_.async_write_some(is_last, buffers, kSocketToken);
        writing_since_.reset();
        peer_gone_ = peer_gone_ || error;
    }
    if (Clock::now() - begun > kSlowWrite) {
        ++slow_writes_;
    }
    co_return is_last&& is_open();
}

void StreamSocket::close_with(CloseCode code, const char* reason) {
    if (closing_.code == CloseCode::none) {
        closing_ = {code, reason};
    }
}

net::awaitable<void> StreamSocket::finish() {
    if (closing_.code != CloseCode::none) {
        auto reason = closing_;
        co_await socket_.async_close(reason, kSocketToken);
    } else {
        socket_.next_layer().close();
    }
    finished_ = true;
    finished_signal_.raise();
}

net::awaitable<void> StreamSocket::watch() {
    while (!finished_) {
        const auto now = Clock::now();
        if (writing_since_ && now - *writing_since_ > stall_max_) {
            close_with(CloseCode::try_again_later, "the client does not read");
        }
        if (writing_since_ && now - *writing_since_ > stall_max_ + kStallGrace) {
            socket_.next_layer().close();
        }
        co_await finished_signal_.wait_until(now + kWatchInterval);
    }
}

}  // namespace modelsynth::server
