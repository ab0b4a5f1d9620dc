#pragma once

#include "server/http/connection.h"
#include "server/http/exchange.h"
#include "server/http/transport.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string_view>

namespace modelsynth::server {

// The requests of a connection, one after the other: their heads and bodies within the limits, and
// what is refused before anything is done. Runs on the socket's strand.
class RequestReader {
  public:
    using Message = boost::beast::http::request<boost::beast::http::string_body>;

    // Both outlive it.
    RequestReader(Transport& stream, const ConnectionContext& context);

    // Reads the next request. The refusal it gets, or nothing when all of it is there; has_ended()
    // when there is nobody to answer.
    [[nodiscard]] net::awaitable<std::optional<Response>> read(Exchange& exchange);

    [[nodiscard]] bool has_ended() const { return ended_; }

    // The request last read, as the protocol's parser has it. Once.
    [[nodiscard]] Message release() { return parser_->release(); }

    // Frees what was kept to read into. For a connection that reads no further request, but may
    // still release() the last one.
    void close();

  private:
    using Clock = std::chrono::steady_clock;
    using ErrorCode = boost::system::error_code;
    using Refusal = std::optional<Response>;

    [[nodiscard]] net::awaitable<Refusal> read_head(Exchange& exchange);
    [[nodiscard]] Refusal parse_head(Exchange& exchange);
    [[nodiscard]] net::awaitable<Refusal> read_body(Exchange& exchange);
    [[nodiscard]] net::awaitable<ErrorCode> read_more(Clock::time_point until);
    [[nodiscard]] net::awaitable<ErrorCode> read_rest();
    [[nodiscard]] std::string_view buffered() const;
    [[nodiscard]] std::size_t find_head_end();
    [[nodiscard]] Response too_many_fields(const Exchange& exchange) const;

    Transport& stream_;
    const ConnectionContext& context_;
    net::steady_timer timer_;
    boost::beast::flat_buffer buffer_;
    std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
    bool ended_ = false;
};

}  // namespace modelsynth::server
