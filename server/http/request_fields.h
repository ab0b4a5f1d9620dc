#pragma once

#include "proto/problem.h"
#include "server/http/message.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What handlers read from query strings and headers.

namespace modelsynth::server {

// As long as an answer is held back at most.
inline constexpr std::uint64_t kWaitSecondsMax = 60;
inline constexpr std::size_t kIdempotencyKeyCharactersMax = 255;

// Digits and nothing else.
[[nodiscard]] std::optional<std::uint64_t> parse_number(const std::string& text);

// Whether it is one, be it negative or more than a number holds.
[[nodiscard]] bool is_whole_number(std::string_view text);

// ASCII alone.
[[nodiscard]] std::string lower_case(std::string text);

// What the body says it is, in lower case and without parameters; nothing when it says nothing.
[[nodiscard]] std::optional<std::string> media_type(const Request& request);

// The items of a comma-separated list without white space and quotes, and without what is quoted
// unless that is wanted.
enum class Quoted : std::uint8_t { kLeftOut, kKept };
[[nodiscard]] std::vector<std::string> list_items(
    const std::string& list, Quoted quoted = Quoted::kLeftOut
);

// wait=N of a Prefer header (RFC 7240), capped; a malformed preference is ignored.
[[nodiscard]] std::optional<std::uint64_t> preferred_wait(const Request& request);

// Whether the answer is wanted as an event stream: Accept names that, and JSON neither before it
// nor with a higher quality. What only wildcards allow is not asked for.
[[nodiscard]] bool wants_event_stream(const Request& request);

// Empty: there is none.
[[nodiscard]] proto::Parsed<std::string> idempotency_key(const Request& request);

}  // namespace modelsynth::server
