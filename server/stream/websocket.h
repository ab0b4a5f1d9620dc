#pragma once

#include "server/http/connection.h"
#include "server/http/message.h"
#include "server/http/transport.h"

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

namespace modelsynth::server {

// Turns the connection into a WebSocket and sends the job's events on it, until the log has ended
// or the client is gone. Clients send nothing.
boost::asio::awaitable<void> serve_job_socket(
    Transport stream,
    boost::beast::http::request<boost::beast::http::string_body> request,
    JobStream wanted,
    ConnectionContext context
);

// Turns the connection into a WebSocket for many jobs, which the client names in messages
// (proto/streams.md), until the client is gone. `upgrade`: on whose behalf.
boost::asio::awaitable<void> serve_shared_socket(
    Transport stream,
    boost::beast::http::request<boost::beast::http::string_body> request,
    SocketUpgrade upgrade,
    ConnectionContext context
);

}  // namespace modelsynth::server
