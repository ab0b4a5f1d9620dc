// From the bytes of a head to a request, with the library's parser between our two checks, as
// server/http/connection.cpp reads them.

#include "server/http/head_check.h"
#include "server/http/message.h"
#include "tests/fuzz/targets/law.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

using namespace modelsynth;
namespace http = boost::beast::http;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    server::Request loose;
    if (server::parse_target(bytes.substr(0, bytes.find('\n')), loose)) {
        for (const std::string& segment : loose.path) {
            law(segment.find('\0') == std::string::npos);
        }
    }
    const std::size_t end = bytes.find("\r\n\r\n");
    if (end == std::string_view::npos) {
        return 0;
    }
    const std::string_view head = bytes.substr(0, end + 4);
    if (server::check_raw_head(head)) {
        return 0;
    }
    http::request_parser<http::string_body> parser;
    parser.header_limit(16 * 1024);
    boost::system::error_code error;
    parser.put(boost::asio::buffer(head.data(), head.size()), error);
    if ((error && error != http::error::need_more) || !parser.is_header_done()) {
        return 0;
    }
    const auto& message = parser.get();
    server::Request request;
    request.method = std::string(message.method_string());
    for (const auto& field : message) {
        std::string name(field.name_string());
        std::transform(name.begin(), name.end(), name.begin(), [](char c) {
            return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
        });
        request.headers.emplace_back(std::move(name), std::string(field.value()));
    }
    if (!server::parse_target(std::string_view(message.target()), request) ||
        server::check_framing(request, message.version())) {
        return 0;
    }
    // What is accepted leaves no doubt where its body ends.
    const auto coding = request.header("transfer-encoding");
    const auto length = request.header("content-length");
    law(!coding || !length);
    law(!coding || (*coding == "chunked" && parser.chunked()));
    law(!length || parser.content_length().has_value());
    law(head.find('\0') == std::string_view::npos);
    return 0;
}
