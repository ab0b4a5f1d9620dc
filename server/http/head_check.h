#pragma once

#include "proto/problem.h"
#include "server/http/message.h"

#include <optional>
#include <string>
#include <string_view>

namespace modelsynth::server {

// What the library's parser lets pass and must not: folded header lines, bytes beyond ASCII in
// the request line, an absolute target. `head` is the raw block from the request line to the
// empty line. Nothing: fine so far.
[[nodiscard]] std::optional<proto::Problem> check_raw_head(std::string_view head);

// What a parsed head must hold before its body is looked at: exactly one Host, a valid one, a
// Transfer-Encoding of nothing but `chunked` and only in HTTP/1.1, at most one Content-Length.
// Any other coding would leave it open where the body ends and the next request begins.
// `version`: 10 or 11. Sets nothing. A problem means that the connection is closed.
[[nodiscard]] std::optional<proto::Problem> check_framing(const Request& request, unsigned version);

}  // namespace modelsynth::server
