#pragma once

#include "server/http/connection.h"
#include "server/http/message.h"

#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include <string>

namespace modelsynth::server {

// Turns the connection into a WebSocket and sends the job's events on it, with frames of what
// blocks changed where the client wants them, until the log has ended or the client is gone.
boost::asio::awaitable<void> serve_websocket(
    boost::beast::tcp_stream stream,
    boost::beast::http::request<boost::beast::http::string_body> request,
    SocketUpgrade upgrade,
    ConnectionContext context
);

}  // namespace modelsynth::server
