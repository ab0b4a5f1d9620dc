#pragma once

#include "server/http/exchange.h"
#include "server/http/transport.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>

#include <chrono>
#include <string>
#include <string_view>

namespace modelsynth::server {

// Writes answers to a connection and keeps account of them in their exchanges. A write that takes
// longer than `most` fails and closes the socket. Runs on the socket's strand; files are read on
// the pool.
class AnswerWriter {
  public:
    // Both outlive it.
    AnswerWriter(Transport& stream, net::thread_pool& pool, std::chrono::seconds most)
        : stream_(stream), pool_(pool), most_(most) {}

    // Each is false when the answer did not get out whole; then the connection is of no more use.

    // Of a response whose body is a text.
    [[nodiscard]] net::awaitable<bool> write_whole(const Response& response, Exchange& exchange);
    // Of one whose body is a file's.
    [[nodiscard]] net::awaitable<bool> write_file(const Response& response, Exchange& exchange);
    // Of one whose body comes bit by bit, and ends with the connection for HTTP/1.0.
    [[nodiscard]] net::awaitable<bool> begin_stream(Response& response, Exchange& exchange);
    [[nodiscard]] net::awaitable<bool> write_chunk(std::string text, Exchange& exchange);
    [[nodiscard]] net::awaitable<bool> end_stream(Exchange& exchange);

    [[nodiscard]] bool has_failed() const { return failed_; }

  private:
    [[nodiscard]] net::awaitable<bool> write_bytes(std::string_view bytes, Exchange& exchange);

    Transport& stream_;
    net::thread_pool& pool_;
    std::chrono::seconds most_;
    bool failed_ = false;
};

}  // namespace modelsynth::server
