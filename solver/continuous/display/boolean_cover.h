#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth::continuous {

// A conjunction of variables and negated variables; of none: true.
struct Cube {
    std::uint32_t variables = 0;  // that stand in it, variable i at bit i
    std::uint32_t values = 0;     // those of them that are not negated

    [[nodiscard]] bool holds_at(std::uint32_t point) const { return (point & variables) == values; }

    friend auto operator<=>(const Cube&, const Cube&) = default;
};

// A Boolean function that matters at some points only; elsewhere it may be anything.
// Shape: bit i of a point is the value of variable i, at most 32 of them; no point stands twice.
struct PartialFunction {
    std::size_t variables = 0;
    std::vector<std::uint32_t> on;   // true here
    std::vector<std::uint32_t> off;  // false here
};

// A disjunction of cubes; of none: false.
using Cover = std::vector<Cube>;

// Up to so many variables all prime implicants are looked at.
inline constexpr std::size_t kPrimesVariablesMax = 9;

// Disjunctions that are true at all of `on` and false at all of `off`, none of whose cubes and
// literals can be left out; those of the fewest literals first. Up to kPrimesVariablesMax variables
// these are chosen among all prime implicants (Quine 1952, McCluskey 1956), shortest ones for sure
// where a search of kCoverNodesMax nodes is enough; beyond that there is one, chosen greedily.
// Requires: `on` is not empty.
// Ensures:  the same for the same points in the same order; empty only when the steps were used up.
// Cost:     of v variables, p points on and q off: 2^v (v p + q) and the search; greedily
//           O(c v q) of c cubes. `steps_left` is lowered by about as much.
inline constexpr std::size_t kCoverNodesMax = 200;
[[nodiscard]] std::vector<Cover> find_covers(
    const PartialFunction& function, std::size_t& steps_left
);

}  // namespace modelsynth::continuous
