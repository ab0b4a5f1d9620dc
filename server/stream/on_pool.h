#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>

#include <utility>

namespace modelsynth::server {

namespace net = boost::asio;

namespace detail {

template <class Work>
net::awaitable<decltype(std::declval<Work&>()())> as_coroutine(Work work) {
    co_return work();
}

}  // namespace detail

// Runs blocking work on the pool; whoever awaits it goes on where it was.
//
//   auto work = [&] { return store.find(id); };   // named: see the note
//   const auto job = co_await on_pool(pool, work);
//
// The work is named on a line of its own because gcc 12 destroys capturing lambdas twice that are
// made within a co_await expression.
template <class Work>
[[nodiscard]] auto on_pool(net::thread_pool& pool, Work& work) {
    return net::co_spawn(pool, detail::as_coroutine(std::ref(work)), net::use_awaitable);
}

}  // namespace modelsynth::server
