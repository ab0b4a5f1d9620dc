#pragma once

#include "solver/mesh/mesh.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {

// The text of a glTF file's nodes array, written node by node; see glb_writer.cpp for why.
class GltfNodes {
  public:
    // Starts a node and returns its number.
    std::uint32_t begin() {
        text_ += count_ == 0 ? "{" : ",{";
        first_ = true;
        return count_++;
    }

    void end() { text_ += '}'; }

    void key(const char* name) {
        text_ += first_ ? "\"" : ",\"";
        text_ += name;
        text_ += "\":";
        first_ = false;
    }

    void raw(const char* text) { text_ += text; }

    template <class Number>
    void number(Number value) {
        std::array<char, 32> digits;
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        text_.append(digits.data(), end);
    }

    void vector(const Vec3& v) {
        text_ += '[';
        number(v.x);
        text_ += ',';
        number(v.y);
        text_ += ',';
        number(v.z);
        text_ += ']';
    }

    void string(const std::string& value) { text_ += quoted(value); }

    void rotation(std::uint8_t quarter_turns) {
        static constexpr std::array<const char*, 4> kQuaternions = {
            "[0,0,0,1]",
            "[0,0.70710678,0,0.70710678]",
            "[0,1,0,0]",
            "[0,-0.70710678,0,0.70710678]"};
        key("rotation");
        raw(kQuaternions[quarter_turns % 4]);
    }

    void range(std::uint32_t first, std::uint32_t count) {
        text_ += '[';
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i > 0) {
                text_ += ',';
            }
            number(first + i);
        }
        text_ += ']';
    }

    void list(const std::vector<std::uint32_t>& values) {
        text_ += '[';
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i > 0) {
                text_ += ',';
            }
            number(values[i]);
        }
        text_ += ']';
    }

    [[nodiscard]] std::size_t bytes() const { return text_.size(); }

    [[nodiscard]] std::uint32_t count() const { return count_; }

    [[nodiscard]] std::string take() { return std::move(text_); }

    static std::string quoted(const std::string& value) {
        std::string text = "\"";
        for (const char c : value) {
            const auto byte = static_cast<unsigned char>(c);
            if (c == '"' || c == '\\') {
                text += '\\';
                text += c;
            } else if (byte < 0x20) {
                static constexpr const char* kHex = "0123456789abcdef";
                text += "\\u00";
                text += kHex[byte >> 4];
                text += kHex[byte & 15];
            } else {
                text += c;
            }
        }
        return text + '"';
    }

  private:
    std::string text_;
    std::uint32_t count_ = 0;
    bool first_ = true;
};

}  // namespace modelsynth
