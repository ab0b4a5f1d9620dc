#pragma once

#include <string>
#include <string_view>

namespace modelsynth::testing {

// Compares the text with the file expected/NAME and tells the first line that differs. With
// UPDATE_GOLDEN=1 in the environment the file is written instead, for `git diff` to judge.
void expect_golden(const std::string& name, const std::string& text);

// Lower-case hex, for what is too long to be kept as it is.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace modelsynth::testing
