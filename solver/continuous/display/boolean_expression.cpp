#include "solver/continuous/display/boolean_expression.h"

#include "solver/core/result.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

using Kind = Expression::Kind;

// Besides the most frequent literals so many others are tried for one cover; of very many cubes
// none.
constexpr std::size_t kTrialsMax = 24;
constexpr std::size_t kCubesFactoredMax = 64;

Expression variable(std::size_t number, bool is_negated) {
    return {Kind::kVariable, is_negated, static_cast<std::uint8_t>(number), {}};
}

// The variable that stands first, a negated one after the same one.
std::pair<std::uint8_t, bool> first_literal(const Expression& expression) {
    return expression.kind == Kind::kVariable || expression.parts.empty()
               ? std::pair(expression.variable, expression.is_negated)
               : first_literal(expression.parts.front());
}

// Variables before what is composed, each by number.
bool stands_before(const Expression& a, const Expression& b) {
    const auto key = [](const Expression& one) {
        return std::tuple(one.kind != Kind::kVariable, first_literal(one), literal_count(one));
    };
    return key(a) < key(b);
}

Expression joined(Kind kind, std::vector<Expression> parts) {
    Expression whole;
    whole.kind = kind;
    for (Expression& part : parts) {
        if (part.kind == kind) {
            std::move(part.parts.begin(), part.parts.end(), std::back_inserter(whole.parts));
        } else {
            whole.parts.push_back(std::move(part));
        }
    }
    std::stable_sort(whole.parts.begin(), whole.parts.end(), stands_before);
    if (whole.parts.size() == 1) {
        Expression only = std::move(whole.parts.front());
        return only;
    }
    return whole;
}

Expression conjunction(const Cube& cube) {
    std::vector<Expression> parts;
    for (std::uint32_t rest = cube.variables; rest != 0; rest &= rest - 1) {
        const auto number = static_cast<std::size_t>(std::countr_zero(rest));
        parts.push_back(variable(number, (cube.values >> number & 1) == 0));
    }
    return joined(Kind::kAnd, std::move(parts));
}

// The literals that all cubes have.
Cube common_to(const Cover& cover) {
    Cube common = cover.front();
    for (const Cube& cube : cover) {
        common.variables &= cube.variables & ~(common.values ^ cube.values);
        common.values &= common.variables;
    }
    return common;
}

bool contains(const Cube& cube, const Cube& part) {
    return (cube.variables & part.variables) == part.variables &&
           (cube.values & part.variables) == part.values;
}

Cube without(const Cube& cube, const Cube& part) {
    return {cube.variables & ~part.variables, cube.values & ~part.variables};
}

Cube together(const Cube& a, const Cube& b) {
    return {a.variables | b.variables, a.values | b.values};
}

// What is left of the cubes that contain a part.
Cover quotient(const Cover& cover, const Cube& part) {
    Cover left;
    for (const Cube& cube : cover) {
        if (contains(cube, part)) {
            left.push_back(without(cube, part));
        }
    }
    return left;
}

// Literals that stand in several cubes, the most frequent ones first.
std::vector<Cube> shared_literals(const Cover& cover) {
    std::uint32_t variables = 0;
    for (const Cube& cube : cover) {
        variables |= cube.variables;
    }
    std::vector<std::pair<std::size_t, Cube>> counted;
    for (std::uint32_t rest = variables; rest != 0; rest &= rest - 1) {
        const std::uint32_t bit = rest & (~rest + 1);
        for (const Cube& literal : {Cube{bit, bit}, Cube{bit, 0}}) {
            const std::size_t count = quotient(cover, literal).size();
            if (count > 1) {
                counted.emplace_back(count, literal);
            }
        }
    }
    std::stable_sort(counted.begin(), counted.end(), [](const auto& a, const auto& b) {
        return a.first > b.first;
    });
    std::vector<Cube> literals;
    for (const auto& [count, literal] : counted) {
        literals.push_back(literal);
    }
    return literals;
}

// cover = divisor * quotient + rest, with every product a cube of the cover.
struct Division {
    Cover divisor;
    Cover quotient;
    Cover rest;
};

Division divided(const Cover& cover, const Cube& literal) {
    Division division;
    division.divisor = quotient(cover, literal);
    const Cube common = common_to(division.divisor);
    for (Cube& cube : division.divisor) {
        cube = without(cube, common);
    }
    for (const Cube& candidate : quotient(cover, division.divisor.front())) {
        const bool divides =
            std::all_of(division.divisor.begin(), division.divisor.end(), [&](const Cube& cube) {
                const Cube product = together(candidate, cube);
                return (candidate.variables & cube.variables) == 0 &&
                       std::find(cover.begin(), cover.end(), product) != cover.end();
            });
        if (divides) {
            division.quotient.push_back(candidate);
        }
    }
    for (const Cube& cube : cover) {
        const bool is_product =
            std::any_of(division.divisor.begin(), division.divisor.end(), [&](const Cube& part) {
                return contains(cube, part) &&
                       std::find(
                           division.quotient.begin(), division.quotient.end(), without(cube, part)
                       ) != division.quotient.end();
            });
        if (!is_product) {
            division.rest.push_back(cube);
        }
    }
    return division;
}

class Factoring {
  public:
    [[nodiscard]] Expression factored(const Cover& cover) {
        if (cover.empty()) {
            return {Kind::kOr, false, 0, {}};
        }
        const Cube common = common_to(cover);
        if (cover.size() == 1) {
            return conjunction(common);
        }
        Cover rest;
        for (const Cube& cube : cover) {
            rest.push_back(without(cube, common));
        }
        std::vector<Expression> factors;
        factors.push_back(conjunction(common));
        factors.push_back(factored_sum(rest));
        return joined(Kind::kAnd, std::move(factors));
    }

  private:
    // Of cubes with no literal that all have.
    Expression factored_sum(const Cover& cover) {
        std::optional<Expression> best;
        const auto literals =
            cover.size() > kCubesFactoredMax ? std::vector<Cube>() : shared_literals(cover);
        for (const Cube& literal : literals) {
            if (best && trials_left_ == 0) {
                break;
            }
            trials_left_ -= best ? 1U : 0U;
            Expression next = product_and_rest(divided(cover, literal));
            if (!best || literal_count(next) < literal_count(*best)) {
                best = std::move(next);
            }
        }
        if (best) {
            return std::move(*best);
        }
        std::vector<Expression> terms;
        for (const Cube& cube : cover) {
            terms.push_back(conjunction(cube));
        }
        return joined(Kind::kOr, std::move(terms));
    }

    Expression product_and_rest(const Division& division) {
        std::vector<Expression> factors;
        factors.push_back(factored(division.quotient));
        factors.push_back(factored(division.divisor));
        std::vector<Expression> terms;
        terms.push_back(joined(Kind::kAnd, std::move(factors)));
        if (!division.rest.empty()) {
            terms.push_back(factored(division.rest));
        }
        return joined(Kind::kOr, std::move(terms));
    }

    std::size_t trials_left_ = kTrialsMax;
};

// What is shorter to read: variables first, then how many parentheses.
std::pair<std::size_t, std::size_t> length_of(const Expression& expression) {
    std::size_t composed = expression.kind == Kind::kVariable ? 0 : 1;
    std::size_t literals = expression.kind == Kind::kVariable ? 1 : 0;
    for (const Expression& part : expression.parts) {
        const auto [part_literals, part_composed] = length_of(part);
        literals += part_literals;
        composed += part_composed;
    }
    return {literals, composed};
}

}  // namespace

std::size_t literal_count(const Expression& expression) { return length_of(expression).first; }

Expression factored(const Cover& cover) { return Factoring().factored(cover); }

Expression negated(Expression expression) {
    switch (expression.kind) {
        case Kind::kVariable:
            expression.is_negated = !expression.is_negated;
            return expression;
        case Kind::kAnd:
            expression.kind = Kind::kOr;
            break;
        case Kind::kOr:
            expression.kind = Kind::kAnd;
            break;
    }
    for (Expression& part : expression.parts) {
        part = negated(std::move(part));
    }
    std::stable_sort(expression.parts.begin(), expression.parts.end(), stands_before);
    return expression;
}

std::optional<Expression> find_short_expression(
    const PartialFunction& function, std::size_t& steps_left
) {
    std::optional<Expression> best;
    const auto offer = [&](Expression next, std::size_t cubes) {
        constexpr std::size_t kWeight = 16;  // formulas are made and thrown away
        const std::size_t tried = std::min(cubes, kCubesFactoredMax);
        steps_left -= std::min(steps_left, kWeight * tried * tried * (kTrialsMax + tried));
        if (!best || length_of(next) < length_of(*best)) {
            best = std::move(next);
        }
    };
    for (const Cover& cover : find_covers(function, steps_left)) {
        offer(factored(cover), cover.size());
    }
    if (!function.off.empty()) {
        const PartialFunction complement = {function.variables, function.off, function.on};
        for (const Cover& cover : find_covers(complement, steps_left)) {
            offer(negated(factored(cover)), cover.size());
        }
    }
    return best;
}

std::string print(const Expression& expression, std::span<const std::string> names) {
    if (expression.kind == Kind::kVariable) {
        check(expression.variable < names.size(), "a variable without a name");
        return (expression.is_negated ? "¬" : "") + names[expression.variable];
    }
    if (expression.parts.empty()) {
        return expression.kind == Kind::kAnd ? "1" : "0";
    }
    std::string text;
    for (const Expression& part : expression.parts) {
        if (!text.empty()) {
            text += expression.kind == Kind::kAnd ? " ∧ " : " ∨ ";
        }
        const std::string inner = print(part, names);
        text += part.kind == Kind::kVariable ? inner : "(" + inner + ")";
    }
    return text;
}

}  // namespace modelsynth::continuous
