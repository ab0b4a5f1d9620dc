#include "proto/base64.h"

#include "solver/core/result.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <limits>

namespace modelsynth::proto {

namespace {

constexpr auto kIsSymbol = [] {
    std::array<bool, 256> is_symbol = {};
    for (const char symbol :
         std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")) {
        is_symbol[static_cast<unsigned char>(symbol)] = true;
    }
    return is_symbol;
}();

}  // namespace

// The decoder of OpenSSL takes '=' for a zero anywhere, and spaces, line ends and '-' at the end
// for nothing; so what it is given is checked first.
tl::expected<std::vector<std::byte>, std::size_t> decode_base64(std::string_view text) {
    check(
        text.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()),
        "a base64 text is too long for its decoder"
    );
    const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
    const std::string_view symbols = text.substr(0, text.size() - padding);
    const auto* const wrong = std::find_if_not(symbols.begin(), symbols.end(), [](char symbol) {
        return kIsSymbol[static_cast<unsigned char>(symbol)];
    });
    if (wrong != symbols.end()) {
        return tl::unexpected(static_cast<std::size_t>(wrong - symbols.begin()));
    }
    static constexpr std::array<std::size_t, 4> kPaddingMax = {0, 0, 2, 1};  // of the last four
    const std::size_t padding_max = kPaddingMax[symbols.size() % 4];
    if (padding > padding_max) {
        return tl::unexpected(symbols.size() + padding_max);
    }
    if (text.size() % 4 != 0) {
        return tl::unexpected(text.size());
    }
    std::vector<std::byte> bytes(text.size() / 4 * 3);
    const int length = EVP_DecodeBlock(
        reinterpret_cast<unsigned char*>(bytes.data()),
        reinterpret_cast<const unsigned char*>(text.data()),
        static_cast<int>(text.size())
    );
    check(length >= 0, "a base64 text that was checked must be decoded");
    bytes.resize(static_cast<std::size_t>(length) - padding);
    return bytes;
}

std::string encode_base64(std::string_view bytes) {
    check(
        bytes.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()),
        "bytes are too many for their encoder"
    );
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // the encoder adds a zero
    EVP_EncodeBlock(
        reinterpret_cast<unsigned char*>(text.data()),
        reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<int>(bytes.size())
    );
    text.pop_back();
    return text;
}

}  // namespace modelsynth::proto
