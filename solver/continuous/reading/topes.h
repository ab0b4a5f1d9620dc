#pragma once

#include "solver/continuous/reading/families.h"
#include "solver/core/result.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A line along which planes of several families meet, up to translation.
struct LineDirection {
    Point direction;         // unit length
    FamilySet families = 0;  // those parallel to it: at least two
};

// A line direction or its opposite: 2 * line for direction, 2 * line + 1 for the opposite; also
// the number of the relation along it.
using Heading = std::uint16_t;

[[nodiscard]] constexpr Heading opposite(Heading heading) {
    return static_cast<Heading>(heading ^ 1U);
}

// A tope is an open cell of the central arrangement of all families: a cone in which every point
// lies on the same sides. At most m (m - 1) + 2 of m families.
using Tope = std::uint16_t;

// The cells, lines and directions of the central arrangement of some planes through one point.
// Thread-safe.
class Topes {
  public:
    // Fails: kInvalidArgument when the normals do not span space, or three of them are so nearly
    // parallel to one line that it cannot be said whether they are.
    [[nodiscard]] static Result<Topes> make(std::vector<Point> normals);

    [[nodiscard]] std::span<const Point> normals() const { return normals_; }

    [[nodiscard]] std::size_t family_count() const { return normals_.size(); }

    [[nodiscard]] std::size_t count() const { return sides_.size(); }

    // On which side of each family the cell lies: bit i is set where n_i . p > 0.
    [[nodiscard]] FamilySet sides(Tope tope) const { return sides_[tope]; }

    // A direction well inside the cell, of unit length.
    [[nodiscard]] const Point& inside(Tope tope) const { return insides_[tope]; }

    // The cell of these sides. Requires: there is one (checked).
    [[nodiscard]] Tope tope_of(FamilySet sides) const;

    // The cell next to this one across a family's plane; itself where they do not share a wall.
    [[nodiscard]] Tope across(Tope tope, std::size_t family) const {
        return across_[tope * normals_.size() + family];
    }

    [[nodiscard]] std::span<const LineDirection> lines() const { return lines_; }

    [[nodiscard]] std::size_t heading_count() const { return 2 * lines_.size(); }

    [[nodiscard]] Point direction(Heading heading) const {
        const Point& along = lines_[heading / 2].direction;
        return heading % 2 == 0 ? along : Point(-along);
    }

    // Sides of the direction itself: which families it lies on the positive side of.
    [[nodiscard]] FamilySet sides_along(Heading heading) const { return sides_along_[heading]; }

    // The cell that one comes into from far along the heading and then a little way into `tope`:
    // the composition of sign vectors (heading o tope).
    [[nodiscard]] Tope composed(Heading heading, Tope tope) const {
        return composed_[heading * sides_.size() + tope];
    }

    // Two families' line. Requires: a != b.
    [[nodiscard]] std::size_t line_of(std::size_t a, std::size_t b) const {
        return line_of_[a * normals_.size() + b];
    }

    // The family that a direction or its opposite, of any length, is normal to.
    [[nodiscard]] std::optional<std::size_t> find_family(const Point& normal) const;

  private:
    Topes() = default;

    std::vector<Point> normals_;
    std::vector<LineDirection> lines_;
    std::vector<std::uint16_t> line_of_;
    std::vector<FamilySet> sides_;
    std::vector<Point> insides_;
    std::map<FamilySet, Tope> tope_of_;
    std::vector<Tope> across_;
    std::vector<FamilySet> sides_along_;
    std::vector<Tope> composed_;
};

}  // namespace modelsynth::continuous
