#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace modelsynth::testing {

// Reads and evaluates formulas as they are printed: h1 ∧ (h2 ∨ ¬h3), 0, 1. Knows nothing of how
// they are made. Operators of two kinds side by side have no meaning and are refused.
class Formula {
  public:
    explicit Formula(std::string_view text) : text_(text) {}

    // `holds(i)`: the value of h_i. Throws std::invalid_argument where the text is no formula.
    [[nodiscard]] bool evaluate(const std::function<bool(std::size_t)>& holds) {
        rest_ = text_;
        const bool value = whole(holds);
        if (!rest_.empty()) {
            throw std::invalid_argument("unread: " + std::string(rest_));
        }
        return value;
    }

    // How many times variables stand in it.
    [[nodiscard]] std::size_t literal_count() const {
        std::size_t count = 0;
        for (const char c : text_) {
            count += c == 'h' ? 1U : 0U;
        }
        return count;
    }

  private:
    bool read(std::string_view token) {
        if (!rest_.starts_with(token)) {
            return false;
        }
        rest_.remove_prefix(token.size());
        return true;
    }

    bool whole(const std::function<bool(std::size_t)>& holds) {
        bool value = part(holds);
        if (rest_.starts_with(" ∧ ")) {
            while (read(" ∧ ")) {
                value = part(holds) && value;
            }
        } else {
            while (read(" ∨ ")) {
                value = part(holds) || value;
            }
        }
        return value;
    }

    bool part(const std::function<bool(std::size_t)>& holds) {
        if (read("(")) {
            const bool value = whole(holds);
            if (!read(")")) {
                throw std::invalid_argument("no ) before " + std::string(rest_));
            }
            return value;
        }
        if (read("1")) {
            return true;
        }
        if (read("0")) {
            return false;
        }
        const bool is_negated = read("¬");
        if (!read("h")) {
            throw std::invalid_argument("no variable before " + std::string(rest_));
        }
        std::size_t number = 0;
        std::size_t digits = 0;
        while (digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9') {
            number = number * 10 + static_cast<std::size_t>(rest_[digits++] - '0');
        }
        if (digits == 0) {
            throw std::invalid_argument("a variable without a number");
        }
        rest_.remove_prefix(digits);
        return holds(number) != is_negated;
    }

    std::string_view text_;
    std::string_view rest_;
};

}  // namespace modelsynth::testing
