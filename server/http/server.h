#pragma once

#include "server/http/api.h"
#include "server/http/http_observer.h"
#include "server/http/tls_identity.h"

#include <spdlog/logger.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace modelsynth::server {

struct HttpConfig {
    std::string address = "127.0.0.1";
    std::uint16_t port = 8080;  // 0 picks one
    std::size_t network_threads = 1;
    std::size_t pool_threads = 4;  // for what blocks
    std::uint32_t drain_delay_seconds = 0;
    TlsFiles tls;  // none: plain HTTP
    HttpLimits limits;
};

// What the server calls, and when; see HttpServer::run().
struct ServerHooks {
    std::function<void()> on_signal;
    std::function<void()> finish_work;
    std::function<void()> on_hangup;
};

// The HTTP and WebSocket front: accepts connections, runs one coroutine for each, hands requests
// to the Api on a pool of its own.
class HttpServer {
  public:
    // `tls` and the observer outlive it.
    HttpServer(
        const HttpConfig& config,
        Api& api,
        TlsIdentity& tls,
        std::shared_ptr<spdlog::logger> log,
        HttpObserver& observer
    );
    ~HttpServer();

    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    // Binds and listens; the answer is the port. Throws std::system_error.
    std::uint16_t listen();

    // Serves until stop() or SIGTERM or SIGINT. On such a signal, one after the other:
    // - `on_signal`, on a network thread: no work is taken any more, which /readyz tells;
    // - the drain delay, in which everything is answered as before, but connections are closed
    //   after an answer, so that those who send requests here can learn to send them elsewhere;
    // - `finish_work`, on a thread that may block;
    // - streams tell what there is to tell and are closed, and run() returns.
    // A second signal ends the process at once. `on_hangup` runs for each SIGHUP, on a network
    // thread.
    void run(const ServerHooks& hooks);

    // Thread-safe.
    void stop();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace modelsynth::server
