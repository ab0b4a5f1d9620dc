#pragma once

#include "solver/continuous/example.h"

#include <array>
#include <span>
#include <vector>

namespace modelsynth::examples {

// A closed outline in a plane, counter-clockwise.
using Outline = std::vector<std::array<double, 2>>;

// The vocabulary of the examples made of solids. Metres, y up.

[[nodiscard]] continuous::Polyhedron box(
    continuous::ObjectId object, const continuous::Point& min, const continuous::Point& max
);

// An outline in x and y, seen from the south, that goes on from z0 to z1, ...
[[nodiscard]] continuous::Polyhedron prism_along_z(
    continuous::ObjectId object, const Outline& outline, double z0, double z1
);

// ... one in z and y, seen from the west, from x0 to x1, ...
[[nodiscard]] continuous::Polyhedron prism_along_x(
    continuous::ObjectId object, const Outline& outline, double x0, double x1
);

// ... and a plan in x and -z, seen from above, from y0 up to y1.
[[nodiscard]] continuous::Polyhedron prism_upwards(
    continuous::ObjectId object, const Outline& outline, double y0, double y1
);

// A pyramid over such a plan.
[[nodiscard]] continuous::Polyhedron pyramid(
    continuous::ObjectId object, const Outline& outline, double y0, const continuous::Point& apex
);

// A box of which each side leans inwards by so much up to its top: slopes, mounds, terraces. Its
// top must keep some length and depth.
struct Insets {
    double west = 0;   // the side of the least x
    double east = 0;   // of the greatest x
    double north = 0;  // of the least z
    double south = 0;  // of the greatest z
};

[[nodiscard]] continuous::Polyhedron tapered(
    continuous::ObjectId object,
    const continuous::Point& min,
    const continuous::Point& max,
    const Insets& insets
);

// A roof over the rectangle from (min.x, min.z) to (max.x, max.z) that rises from min.y at 45
// degrees on all four sides: to a ridge, or to a point over a square. max.y does not matter.
[[nodiscard]] continuous::Polyhedron hip_roof(
    continuous::ObjectId object, const continuous::Point& min, const continuous::Point& max
);

// The same solid elsewhere.
[[nodiscard]] continuous::Polyhedron moved(
    continuous::Polyhedron solid, const continuous::Point& by
);

// Boxes that may overlap, as boxes that don't, of which the later one took the place: a window in a
// wall is seen, whoever draws the solids.
class Blocks {
  public:
    void add(
        continuous::ObjectId object, const continuous::Point& min, const continuous::Point& max
    );

    void append_to(std::vector<continuous::Polyhedron>& solids) const;

  private:
    struct Block {
        continuous::ObjectId object;
        continuous::Point min;
        continuous::Point max;
    };

    std::vector<Block> blocks_;
};

// A linear colour from the usual notation 0xRRGGBB.
[[nodiscard]] Color color(std::uint32_t srgb);

}  // namespace modelsynth::examples
