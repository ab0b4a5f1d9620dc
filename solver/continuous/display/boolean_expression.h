#pragma once

#include "solver/continuous/display/boolean_cover.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// A formula of conjunctions, disjunctions and negated variables.
// Shape: a conjunction or disjunction has no part of its own kind, and not just one part; a
// conjunction of no parts is true, a disjunction of none false.
struct Expression {
    enum class Kind : std::uint8_t { kVariable, kAnd, kOr };

    Kind kind = Kind::kAnd;
    bool is_negated = false;  // of a variable
    std::uint8_t variable = 0;
    std::vector<Expression> parts;
};

// How many times variables stand in it.
[[nodiscard]] std::size_t literal_count(const Expression& expression);

// A disjunction with common parts taken out: a ∧ (b ∨ c) in place of (a ∧ b) ∨ (a ∧ c). Good, not
// always shortest: algebraic division (Brayton 1982) by the most frequent literal and, as often as
// that is little work, by every other one; sums of very many cubes stay as they are.
// Cost: O(c^3) of c cubes.
[[nodiscard]] Expression factored(const Cover& cover);

// What is true where the other is false: De Morgan's laws, down to the variables.
[[nodiscard]] Expression negated(Expression expression);

// A short formula that is true at all points on and false at all points off. The shortest of the
// factored covers of either and the negated ones of the other; where several are equally short,
// one of the first kind.
// Requires: `on` is not empty.
// Fails:    nothing when the steps were used up; see find_covers().
[[nodiscard]] std::optional<Expression> find_short_expression(
    const PartialFunction& function, std::size_t& steps_left
);

// UTF-8: names[0] ∧ (names[1] ∨ ¬names[2]); 1 for true, 0 for false. What stands within another
// operator is in parentheses.
// Requires: a name for each variable (checked).
[[nodiscard]] std::string print(const Expression& expression, std::span<const std::string> names);

}  // namespace modelsynth::continuous
