#include "solver/core/svg_text.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace modelsynth {

std::string svg_number(double value) {
    const auto tenths = static_cast<std::int64_t>(std::lround(value * 10));
    const std::string sign = tenths < 0 ? "-" : "";
    const std::int64_t size = std::abs(tenths);
    return sign + std::to_string(size / 10) +
           (size % 10 == 0 ? "" : "." + std::to_string(size % 10));
}

std::string svg_escaped(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        escaped += c == '&'                                ? "&amp;"
                   : c == '<'                              ? "&lt;"
                   : c == '>'                              ? "&gt;"
                   : static_cast<unsigned char>(c) < 0x20U ? "?"
                                                           : std::string(1, c);
    }
    return escaped;
}

std::string shortened(const std::string& text, std::size_t bytes_max) {
    if (text.size() <= bytes_max) {
        return text;
    }
    std::size_t length = bytes_max - 1;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) {
        --length;
    }
    return text.substr(0, length) + "…";
}

}  // namespace modelsynth
