#pragma once

#include "solver/continuous/display/boolean_expression.h"
#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/topes.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// Writes where an object stands in a figure as the thesis does (4.5.1, 4.5.3): as a Boolean
// expression of the half-spaces h1 ... hm, like h1 ∧ (h2 ∨ ¬h3). h_i is what lies below the planes
// of family i - 1: n . p < 0, so that a face whose outer normal is the family's is h_i alone, and
// one that looks the other way ¬h_i. Sides that no cell of the arrangement has may come out either
// way.
//
// An object's expression has only families across whose planes the object begins or ends, and is
// exact: it holds in the topes where the object is, and in no other.
//
// Cost: of r families that matter and t <= r (r - 1) + 2 cells of these, 2^r (r + 1) t up to nine
//       families, and O(c r t) of c terms beyond; equal patterns are worked out once. A writer
//       takes kExpressionStepsMax such steps in all, some tenths of a second; a built-in example
//       takes milliseconds. After that, and where an expression is longer than
//       kExpressionLengthMax literals, nothing is written rather than something wrong.
// Not thread-safe.
inline constexpr std::size_t kExpressionStepsMax = std::size_t{1} << 27;
inline constexpr std::size_t kExpressionLengthMax = 128;

class ExpressionWriter {
  public:
    // Requires: `topes` outlives it.
    explicit ExpressionWriter(const Topes& topes);

    // "1" where it is all around the point. Requires: the object stands in the figure (checked).
    [[nodiscard]] std::optional<std::string> write(const Figure& figure, ObjectId object);

  private:
    const Topes& topes_;
    std::vector<std::string> names_;
    // By the points on and off.
    std::map<std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>, Expression> known_;
    std::size_t steps_left_ = kExpressionStepsMax;
};

// The objects of a figure other than empty space, by number.
[[nodiscard]] std::vector<ObjectId> objects_in(const Figure& figure);

}  // namespace modelsynth::continuous
