#include "tests/golden/golden.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace modelsynth::testing {

void expect_golden(const std::string& name, const std::string& text) {
    const std::string path = std::string(MODELSYNTH_GOLDEN_DIR) + "/" + name;
    if (std::getenv("UPDATE_GOLDEN") != nullptr) {
        std::ofstream file(path, std::ios::binary);
        file << text;
        ASSERT_TRUE(file.flush()) << path;
        return;
    }
    std::ifstream file(path, std::ios::binary);
    ASSERT_TRUE(file) << path << " is missing; UPDATE_GOLDEN=1 writes it";
    const std::string expected((std::istreambuf_iterator<char>(file)), {});
    if (expected == text) {
        return;
    }
    std::istringstream expected_lines(expected);
    std::istringstream lines(text);
    std::string expected_line;
    std::string line;
    for (int number = 1;; ++number) {
        const bool more_expected = static_cast<bool>(std::getline(expected_lines, expected_line));
        const bool more = static_cast<bool>(std::getline(lines, line));
        if (!more_expected || !more || expected_line != line) {
            ADD_FAILURE() << name << ":" << number << " differs\n  expected: "
                          << (more_expected ? expected_line : "(the end)")
                          << "\n  is:       " << (more ? line : "(the end)")
                          << "\nUPDATE_GOLDEN=1 rewrites it when the change is wanted";
            return;
        }
    }
}

std::string sha256_hex(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest = {};
    unsigned int length = 0;
    EXPECT_EQ(
        EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr), 1
    );
    static constexpr const char* kHex = "0123456789abcdef";
    std::string hex;
    for (unsigned int i = 0; i < length; ++i) {
        hex += kHex[digest[i] >> 4];
        hex += kHex[digest[i] & 15];
    }
    return hex;
}

}  // namespace modelsynth::testing
