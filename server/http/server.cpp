#include "server/http/server.h"

#include "server/http/connection.h"
#include "server/log/event_line.h"
#include "server/stream/frame_source.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <pthread.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace net = boost::asio;
using net::ip::tcp;

struct HttpServer::State {
    State(
        const HttpConfig& given,
        Api& given_api,
        TlsIdentity& given_tls,
        std::shared_ptr<spdlog::logger> logger,
        HttpObserver& given_observer
    )
        : config(given),
          api(given_api),
          tls(given_tls),
          log(std::move(logger)),
          observer(given_observer),
          acceptor(io),
          signals(io),
          hangups(io, SIGHUP),
          frames(given_api.service()),
          pool(given.pool_threads) {}

    HttpConfig config;
    Api& api;
    TlsIdentity& tls;
    std::shared_ptr<spdlog::logger> log;
    HttpObserver& observer;
    ConnectionCounters counters;  // connections that are left go with the next one
    net::io_context io;
    tcp::acceptor acceptor;
    net::signal_set signals;
    net::signal_set hangups;
    FrameSource frames;
    net::thread_pool pool;  // last: its threads are joined while the rest still stands
};

namespace {

// The calling thread has this name meanwhile, and so have the threads that it makes: those of the
// library's pool cannot be named otherwise.
class ThreadName {
  public:
    explicit ThreadName(const char* name) {
        ::pthread_getname_np(::pthread_self(), before_.data(), before_.size());
        ::pthread_setname_np(::pthread_self(), name);
    }

    ThreadName(const ThreadName&) = delete;
    ThreadName& operator=(const ThreadName&) = delete;

    ~ThreadName() { ::pthread_setname_np(::pthread_self(), before_.data()); }

  private:
    std::array<char, 16> before_ = {};
};

void log_failure(const std::shared_ptr<spdlog::logger>& log, const std::exception_ptr& failure) {
    if (!failure) {
        return;
    }
    try {
        std::rethrow_exception(failure);
    } catch (const std::logic_error& error) {
        log_event(*log, spdlog::level::err, "a connection threw", {{"what", error.what()}});
    } catch (const std::exception& error) {
        log_event(*log, spdlog::level::debug, "connection ended", {{"what", error.what()}});
    }
}

net::awaitable<void> accept_connections(
    tcp::acceptor& acceptor,
    net::io_context& io,
    ConnectionContext context,
    std::shared_ptr<spdlog::logger> log
) {
    constexpr auto kToken = net::as_tuple(net::use_awaitable);
    net::steady_timer pause(co_await net::this_coro::executor);
    for (;;) {
        auto strand = net::make_strand(io);
        auto [error, socket] = co_await acceptor.async_accept(strand, kToken);
        if (error == net::error::operation_aborted || !acceptor.is_open()) {
            co_return;
        }
        if (error) {
            // Out of descriptors, mostly: accepting again at once would only burn the processor.
            log_event(*log, spdlog::level::warn, "accepting failed", {{"why", error.message()}});
            pause.expires_after(std::chrono::milliseconds(100));
            co_await pause.async_wait(kToken);
            continue;
        }
        auto on_end = [log](std::exception_ptr failure) { log_failure(log, failure); };
        net::co_spawn(strand, serve_connection(std::move(socket), context), on_end);
    }
}

// Calls for each SIGHUP.
net::awaitable<void> await_hangups(net::signal_set& hangups, const std::function<void()>& call) {
    constexpr auto kToken = net::as_tuple(net::use_awaitable);
    for (;;) {
        auto [error, signal] = co_await hangups.async_wait(kToken);
        if (error) {
            co_return;
        }
        call();
    }
}

}  // namespace

HttpServer::HttpServer(
    const HttpConfig& config,
    Api& api,
    TlsIdentity& tls,
    std::shared_ptr<spdlog::logger> log,
    HttpObserver& observer
) {
    const ThreadName inherited("pool");
    state_ = std::make_unique<State>(config, api, tls, std::move(log), observer);
}

HttpServer::~HttpServer() {
    state_->io.stop();
    state_->pool.join();
}

std::uint16_t HttpServer::listen() {
    const tcp::endpoint endpoint(
        net::ip::make_address(state_->config.address), state_->config.port
    );
    state_->acceptor.open(endpoint.protocol());
    state_->acceptor.set_option(net::socket_base::reuse_address(true));
    state_->acceptor.bind(endpoint);
    state_->acceptor.listen(net::socket_base::max_listen_connections);
    return state_->acceptor.local_endpoint().port();
}

void HttpServer::run(const ServerHooks& hooks) {
    State& state = *state_;
    state.signals.add(SIGTERM);
    state.signals.add(SIGINT);
    std::thread drainer;
    state.signals.async_wait([&](boost::system::error_code error, int signal) {
        if (error) {
            return;
        }
        log_event(*state.log, spdlog::level::info, "draining", {{"signal", signal}});
        state.counters.stopping = true;
        hooks.on_signal();
        // A second signal does not wait for anything.
        state.signals.async_wait([](boost::system::error_code again, int) {
            if (!again) {
                std::_Exit(1);
            }
        });
        drainer = std::thread([&] {
            std::this_thread::sleep_for(std::chrono::seconds(state.config.drain_delay_seconds));
            hooks.finish_work();
            state.counters.draining = true;
            // What streams notice within their next wait, and a little more.
            for (int i = 0; i < 30 && state.counters.open.count() > 0; ++i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            }
            stop();
        });
    });
    const ConnectionContext context = {
        &state.api,
        &state.pool,
        &state.counters,
        &state.frames,
        &state.tls,
        state.config.limits,
        state.log,
        &state.observer};
    net::co_spawn(
        state.io,
        accept_connections(state.acceptor, state.io, context, state.log),
        [](const std::exception_ptr&) {}
    );
    net::co_spawn(
        state.io, await_hangups(state.hangups, hooks.on_hangup), [](const std::exception_ptr&) {}
    );
    std::vector<std::thread> threads;
    const auto serve = [&state] {
        for (;;) {
            try {
                state.io.run();
                return;
            } catch (const std::exception& error) {
                log_event(
                    *state.log, spdlog::level::err, "a handler threw", {{"what", error.what()}}
                );
            }
        }
    };
    for (std::size_t i = 1; i < state.config.network_threads; ++i) {
        threads.emplace_back(serve);
    }
    serve();
    for (std::thread& thread : threads) {
        thread.join();
    }
    if (drainer.joinable()) {
        drainer.join();
    }
}

void HttpServer::stop() { state_->io.stop(); }

}  // namespace modelsynth::server
