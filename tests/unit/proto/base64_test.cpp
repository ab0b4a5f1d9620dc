#include "proto/base64.h"

#include "tests/support/png_file.h"

#include <gtest/gtest.h>

#include <string>

namespace modelsynth::proto {
namespace {

TEST(Base64, GivesBackWhatWasEncoded) {
    std::string bytes;
    for (int i = 0; i < 600; ++i) {
        const auto decoded = decode_base64(modelsynth::testing::encode_base64(bytes));
        ASSERT_TRUE(decoded) << i;
        EXPECT_EQ(
            std::string(reinterpret_cast<const char*>(decoded->data()), decoded->size()), bytes
        );
        bytes += static_cast<char>(i * 37);
    }
}

TEST(Base64, NamesTheFirstCharacterThatCannotStandThere) {
    const std::vector<std::pair<std::string, std::size_t>> faults = {
        {"A", 1},
        {"AA", 2},
        {"AAA", 3},
        {"AA=", 3},  // one more '=' is missing
        {"AAAAA", 5},
        {"=", 0},
        {"==", 0},
        {"A=", 1},
        {"A==", 1},
        {"A===", 1},
        {"AAA==", 4},
        {"AAAA=", 4},
        {"AAAA====", 4},
        {"AA==AAAA", 2},
        {"AAA=AAA=", 3},
        {"AA=A", 2},
        {" AAA", 0},
        {"AAA\n", 3},
        {"AAAA\n", 4},
        {"AAAA----", 4},
        {"AA-_", 2},  // the other alphabet, of RFC 4648, section 5
        {std::string("AAA\0", 4), 3},
        {"AAA\xFF", 3}};
    for (const auto& [text, at] : faults) {
        const auto decoded = decode_base64(text);
        ASSERT_FALSE(decoded) << text;
        EXPECT_EQ(decoded.error(), at) << text;
    }
}

}  // namespace
}  // namespace modelsynth::proto
