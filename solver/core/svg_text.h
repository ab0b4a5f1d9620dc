#pragma once

#include <cstddef>
#include <string>

// What drawings are written with: the same text for the same values on any machine.

namespace modelsynth {

// A number to a tenth, without a locale.
[[nodiscard]] std::string svg_number(double value);

// Text as XML may hold it; control characters, which it cannot hold, become question marks.
[[nodiscard]] std::string svg_escaped(const std::string& text);

// A text of more than so many bytes, cut between two characters of UTF-8, with "…" in place of the
// rest. Requires: bytes_max > 0.
[[nodiscard]] std::string shortened(const std::string& text, std::size_t bytes_max);

}  // namespace modelsynth
