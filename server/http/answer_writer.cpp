#include "server/http/answer_writer.h"

#include "proto/timestamp.h"
#include "server/stream/on_pool.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/status.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>

namespace modelsynth::server {

namespace {

namespace http = boost::beast::http;

constexpr auto kWriteToken = net::as_tuple(net::use_awaitable);

std::string head_text(
    const Response& response, Exchange& exchange, std::optional<std::uint64_t> length
) {
    exchange.answer.status = response.status;
    exchange.answer.problem = response.problem;
    std::string text =
        "HTTP/1.1 " + std::to_string(response.status) + " " +
        std::string(http::obsolete_reason(static_cast<http::status>(response.status))) + "\r\n";
    std::string vary;
    const Fields& answer_fields = exchange.request.answer_fields;
    for (const Fields* fields : {&response.headers, &answer_fields}) {
        for (const auto& [name, value] : *fields) {
            if (name == "Vary") {
                vary += (vary.empty() ? "" : ", ") + value;
            } else {
                text += name + ": " + value + "\r\n";
            }
        }
    }
    text += vary.empty() ? "" : "Vary: " + vary + "\r\n";
    text += "Date: " + proto::to_http_date(proto::now_millis()) +
            "\r\nX-Request-Id: " + exchange.request.id +
            "\r\nServer: modelsynthd\r\nX-Content-Type-Options: nosniff\r\n";
    if (length) {
        text += "Content-Length: " + std::to_string(*length) + "\r\n";
    }
    if (!exchange.keep_alive) {
        text += "Connection: close\r\n";
    } else if (exchange.version < 11) {
        text += "Connection: keep-alive\r\n";
    }
    return text + "\r\n";
}

}  // namespace

net::awaitable<bool> AnswerWriter::write_bytes(std::string_view bytes, Exchange& exchange) {
    stream_.expires_after(most_);
    auto buffer = net::buffer(bytes.data(), bytes.size());
    auto [error, count] = co_await net::async_write(stream_, buffer, kWriteToken);
    exchange.answer.bytes += count;
    failed_ = failed_ || error;
    co_return !error;
}

net::awaitable<bool> AnswerWriter::write_whole(const Response& response, Exchange& exchange) {
    const auto& body = std::get<std::string>(response.body);
    // 204 and 304 have no content, not even an empty one.
    const bool has_content = response.status != 204 && response.status != 304;
    const auto length = has_content ? std::optional<std::uint64_t>(body.size()) : std::nullopt;
    std::string text = head_text(response, exchange, length);
    if (has_content && exchange.request.method != "HEAD") {
        text += body;
    }
    co_return co_await write_bytes(text, exchange);
}

net::awaitable<bool> AnswerWriter::write_file(const Response& response, Exchange& exchange) {
    constexpr std::uint64_t kPiece = 256 * 1024;
    FileBody body = std::get<FileBody>(response.body);
    const std::string head = head_text(response, exchange, body.length);
    if (!co_await write_bytes(head, exchange) || exchange.request.method == "HEAD") {
        co_return !failed_;
    }
    std::string piece;
    while (body.length > 0) {
        piece.resize(std::min(kPiece, body.length));
        auto read = [&body, &piece] { return body.reader->read(body.offset, piece); };
        const auto got = co_await on_pool(pool_, read);
        if (!got || !co_await write_bytes(piece, exchange)) {
            failed_ = true;  // a length was promised that cannot be kept
            co_return false;
        }
        body.offset += piece.size();
        body.length -= piece.size();
    }
    co_return true;
}

net::awaitable<bool> AnswerWriter::begin_stream(Response& response, Exchange& exchange) {
    exchange.keep_alive = false;
    exchange.answer.is_stream = true;
    if (exchange.version >= 11) {
        response.headers.emplace_back("Transfer-Encoding", "chunked");
    }
    const std::string head = head_text(response, exchange, std::nullopt);
    co_return co_await write_bytes(head, exchange);
}

net::awaitable<bool> AnswerWriter::write_chunk(std::string text, Exchange& exchange) {
    if (exchange.version >= 11) {
        std::array<char, 20> size = {};
        const int digits = std::snprintf(size.data(), size.size(), "%zx\r\n", text.size());
        text = std::string(size.data(), static_cast<std::size_t>(digits)) + text + "\r\n";
    }
    co_return co_await write_bytes(text, exchange);
}

net::awaitable<bool> AnswerWriter::end_stream(Exchange& exchange) {
    static constexpr std::string_view kLastChunk = "0\r\n\r\n";
    if (exchange.version < 11) {
        co_return true;
    }
    co_return co_await write_bytes(kLastChunk, exchange);
}

}  // namespace modelsynth::server
