#pragma once

#include "server/http/api.h"
#include "server/http/transport.h"
#include "server/stream/wake_signal.h"

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace modelsynth::server {

// A WebSocket with the manners of this service: subprotocol, heartbeats, messages of at most
// proto::kStreamMessageBytesMax from the client, an end for clients that take nothing. One
// coroutine reads, one writes, one runs watch(); all on the connection's strand.
class StreamSocket {
  public:
    using CloseCode = boost::beast::websocket::close_code;

    StreamSocket(Transport stream, const HttpLimits& limits);

    StreamSocket(const StreamSocket&) = delete;
    StreamSocket& operator=(const StreamSocket&) = delete;

    // Answers the handshake, with its X-Request-Id; false when that failed.
    [[nodiscard]] net::awaitable<bool> accept(
        const boost::beast::http::request<boost::beast::http::string_body>& request
    );

    struct Message {
        std::string bytes;
        bool is_text = true;
    };

    // The client's next message; nothing when it is gone or broke a rule. Answers control frames
    // meanwhile, so that one is always to be read.
    [[nodiscard]] net::awaitable<std::optional<Message>> read();

    // False when the client is gone or the socket is to be closed.
    [[nodiscard]] net::awaitable<bool> write_text(std::string_view text);
    // `head` and `payload` as one message.
    [[nodiscard]] net::awaitable<bool> write_binary(
        std::string_view head, std::string_view payload
    );

    // Whether there is any use in writing.
    [[nodiscard]] bool is_open() const { return !peer_gone_ && closing_.code == CloseCode::none; }

    // From now on it is to be closed so; the first reason counts.
    void close_with(CloseCode code, const char* reason);

    // Closes it, with the reason if there is one. The writer's last call.
    [[nodiscard]] net::awaitable<void> finish();

    // Ends the connection of a client that takes nothing for too long. Returns after finish().
    [[nodiscard]] net::awaitable<void> watch();

    // How many writes took longer than a client needs that keeps up.
    [[nodiscard]] std::uint64_t slow_writes() const { return slow_writes_; }

    [[nodiscard]] net::any_io_executor executor() { return socket_.get_executor(); }

  private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] net::awaitable<bool> write(
        bool is_binary, std::string_view head, std::string_view payload
    );

    boost::beast::websocket::stream<Transport> socket_;
    WakeSignal finished_signal_;
    std::chrono::seconds stall_max_;
    boost::beast::websocket::close_reason closing_;  // none: the client closes, or is gone
    bool peer_gone_ = false;
    bool finished_ = false;
    std::optional<Clock::time_point> writing_since_;  // the piece that is on its way
    std::uint64_t slow_writes_ = 0;
};

}  // namespace modelsynth::server
