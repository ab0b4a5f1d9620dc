#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>

#include <chrono>

namespace modelsynth::server {

namespace net = boost::asio;

// Lets one coroutine sleep until there is something to do. Lower it, look for work, then wait: what
// is raised in between ends the wait at once. From the executor only.
class WakeSignal {
  public:
    using Clock = std::chrono::steady_clock;

    explicit WakeSignal(const net::any_io_executor& executor) : timer_(executor) {}

    void raise() {
        raised_ = true;
        timer_.cancel();
    }

    void lower() { raised_ = false; }

    [[nodiscard]] net::awaitable<void> wait_until(Clock::time_point until) {
        if (!raised_) {
            timer_.expires_at(until);
            constexpr auto kToken = net::as_tuple(net::use_awaitable);
            co_await timer_.async_wait(kToken);
        }
    }

  private:
    net::steady_timer timer_;
    bool raised_ = false;
};

}  // namespace modelsynth::server
