#pragma once

#include "tests/support/polygon_set.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace modelsynth::testing {

// The cones into which the planes through one point with some normals cut space, numbered by the
// sides of the planes on which they lie: found anew, without the solver's topes.
class ConeCells {
  public:
    // Normals that are nearly parallel, whichever way they point, count once.
    explicit ConeCells(const std::vector<Point>& normals);

    [[nodiscard]] const std::vector<Point>& normals() const { return normals_; }

    // The normal's number among these, the same for its opposite.
    [[nodiscard]] std::optional<std::size_t> find(const Point& normal) const;

    [[nodiscard]] std::size_t count() const { return cells_.size(); }

    // How many there must be, by Euler's formula for great circles on a sphere.
    [[nodiscard]] std::size_t expected_count() const { return expected_count_; }

    // Bit i: whether the cell is on the positive side of normal i.
    [[nodiscard]] std::uint64_t sides(std::size_t cell) const { return cells_[cell].sides; }

    // A direction of unit length inside the cell.
    [[nodiscard]] const Point& inside(std::size_t cell) const { return cells_[cell].inside; }

  private:
    struct Cell {
        std::uint64_t sides = 0;
        Point inside;
    };

    [[nodiscard]] std::uint64_t sides_of(const Point& direction) const;

    std::vector<Point> normals_;
    std::vector<Cell> cells_;  // by sides, rising
    std::size_t expected_count_ = 2;
};

}  // namespace modelsynth::testing
