#pragma once

#include "server/http/api.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <spdlog/logger.h>

#include <atomic>
#include <cstddef>
#include <memory>

namespace modelsynth::server {

class FrameSource;

// What all connections share.
struct ConnectionCounters {
    std::atomic<std::size_t> open = 0;
    std::atomic<bool> draining = false;
};

// Everything pointed to outlives all connections.
struct ConnectionContext {
    Api* api;
    boost::asio::thread_pool* pool;
    ConnectionCounters* counters;
    FrameSource* frames;
    HttpLimits limits;
    std::shared_ptr<spdlog::logger> log;
};

// Serves one connection to its end: requests one after the other, or a stream. Runs on the
// socket's strand; what blocks runs on the pool.
boost::asio::awaitable<void> serve_connection(
    boost::asio::ip::tcp::socket socket, ConnectionContext context
);

}  // namespace modelsynth::server
