#pragma once

#include "server/http/message.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace modelsynth::server {

enum class ContentCoding : std::uint8_t { kIdentity, kGzip };

// What is smaller is sent as it is: it fits into a packet anyway.
inline constexpr std::size_t kCodedBytesMin = 1024;

// What an Accept-Encoding header allows (RFC 9110 12.5.3); without one, all is sent as it is.
// Items that are malformed are left out.
struct AcceptedCodings {
    bool identity = true;
    bool gzip = false;
    bool prefers_gzip = false;  // gzip, and identity not more than that
};

[[nodiscard]] AcceptedCodings parse_accept_encoding(const std::optional<std::string>& list);

// How a body of that size is sent; nothing when the client takes it in no way. A part of a body is
// one of the body as it is, so who asks for one gets no coding.
[[nodiscard]] std::optional<ContentCoding> choose_coding(
    const Request& request, std::uint64_t size, bool can_be_coded = true
);

// Codes an answer that is made for this request alone and says nothing of codings yet, when it is
// text. Never refuses: what was done cannot be undone because of the form of the answer.
void code_body(const Request& request, Response& response);

}  // namespace modelsynth::server
