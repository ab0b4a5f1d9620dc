#pragma once

#include <cstdint>
#include <functional>
#include <string>

// Checks that options are declared with: what is wrong with a text, or nothing. The library's own
// take 010 for 8, 0x10 for 16, and nan for a number of any range.

namespace modelsynth::server {

using OptionCheck = std::function<std::string(const std::string&)>;

// A number from `least` to `most`, written in decimal digits.
[[nodiscard]] OptionCheck check_whole_number(std::uint64_t least, std::uint64_t most);

// The same with a fraction: 0.5 or 2e3.
[[nodiscard]] OptionCheck check_number(double least, double most);

}  // namespace modelsynth::server
