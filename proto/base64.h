#pragma once

#include <tl/expected.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

// The bytes of a base64 text (RFC 4648, section 4): padded, and without spaces or line ends.
// Fails:    the index of the first character that cannot stand where it stands, text.size() when
//           the text ends too early.
// Requires: text.size() fits an int (checked).
[[nodiscard]] tl::expected<std::vector<std::byte>, std::size_t> decode_base64(std::string_view text
);

// The inverse.
// Requires: bytes.size() fits an int (checked).
[[nodiscard]] std::string encode_base64(std::string_view bytes);

}  // namespace modelsynth::proto
