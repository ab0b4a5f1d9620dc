#pragma once

#include "server/http/api.h"

#include <spdlog/logger.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

namespace modelsynth::server {

struct HttpConfig {
    std::string address = "127.0.0.1";
    std::uint16_t port = 8080;  // 0 picks one
    std::size_t network_threads = 1;
    std::size_t pool_threads = 4;  // for what blocks
    HttpLimits limits;
};

// The HTTP and WebSocket front: accepts connections, runs one coroutine for each, hands requests
// to the Api on a pool of its own.
class HttpServer {
  public:
    HttpServer(const HttpConfig& config, Api& api, std::shared_ptr<spdlog::logger> log);
    ~HttpServer();

    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    // Binds and listens; the answer is the port. Throws std::system_error.
    std::uint16_t listen();

    // Serves until stop() or SIGTERM or SIGINT. On a signal: /readyz turns 503 and submissions
    // are refused, `on_signal` runs (on a thread that may block), streams are closed, and run()
    // returns. A second signal ends the process at once. `on_hangup` runs for each SIGHUP, on a
    // network thread.
    void run(const std::function<void()>& on_signal, const std::function<void()>& on_hangup);

    // Thread-safe.
    void stop();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace modelsynth::server
