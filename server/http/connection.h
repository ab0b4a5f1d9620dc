#pragma once

#include "server/http/api.h"
#include "server/http/http_observer.h"
#include "server/http/open_connections.h"
#include "server/http/tls_identity.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <spdlog/logger.h>

#include <atomic>
#include <memory>

namespace modelsynth::server {

class FrameSource;

// What all connections share.
struct ConnectionCounters {
    OpenConnections open;
    std::atomic<bool> stopping = false;  // connections are closed after their next answer
    std::atomic<bool> draining = false;  // ... and streams once they have told what there is
};

// Everything pointed to outlives all connections.
struct ConnectionContext {
    Api* api;
    boost::asio::thread_pool* pool;
    ConnectionCounters* counters;
    FrameSource* frames;
    TlsIdentity* tls;
    HttpLimits limits;
    std::shared_ptr<spdlog::logger> log;
    HttpObserver* observer;
};

// Serves one connection to its end: requests one after the other, or a stream. Runs on the
// socket's strand; what blocks runs on the pool.
boost::asio::awaitable<void> serve_connection(
    boost::asio::ip::tcp::socket socket, ConnectionContext context
);

}  // namespace modelsynth::server
