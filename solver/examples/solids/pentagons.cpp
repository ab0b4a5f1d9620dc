#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

#include <cmath>
#include <numbers>
#include <string>

namespace modelsynth::examples {

namespace {

using continuous::ObjectId;
using continuous::Point;

enum : ObjectId { kPaving = 1, kPlinth, kWall, kRoof, kCorner };

constexpr int kSides = 5;

// A regular pentagon whose sides are `apothem` from (x, z). One corner points north, or with `sign`
// -1 south: the five walls have the same five directions either way.
struct Pentagon {
    double x, z, apothem;
    int sign;

    // Where a line `inset` within one side meets one `next_inset` within the next side.
    [[nodiscard]] std::array<double, 2> corner(int side, double inset, double next_inset) const {
        const double a = angle(side);
        const double b = angle(side + 1);
        const double p = apothem - inset;
        const double q = apothem - next_inset;
        const double det = std::sin(b - a);
        return {
            x + (p * std::sin(b) - q * std::sin(a)) / det,
            -z + (q * std::cos(a) - p * std::cos(b)) / det};
    }

    [[nodiscard]] double angle(int side) const {
        return std::numbers::pi * (0.5 * sign + 0.2 + 0.4 * side);
    }
};

void add_tower(continuous::Example& example, const Pentagon& plan, double height) {
    Outline whole;
    Outline plinth;
    for (int side = 0; side < kSides; ++side) {
        const auto outer = plan.corner(side, 0, 0);
        const auto before = plan.corner(side, 0, 1);
        const auto within = plan.corner(side, 1, 1);
        const auto after = plan.corner(side, 1, 0);
        whole.push_back(outer);
        plinth.insert(plinth.end(), {before, within, after});
        example.polyhedra.push_back(prism_upwards(
            static_cast<ObjectId>(kCorner + side), {within, before, outer, after}, 0, 1
        ));
    }
    example.polyhedra.push_back(prism_upwards(kPlinth, plinth, 0, 1));
    example.polyhedra.push_back(prism_upwards(kWall, whole, 1, height));
    example.polyhedra.push_back(prism_upwards(kRoof, whole, height, height + 1));
}

}  // namespace

// Pentagonal towers of different heights that grow into each other (thesis, Figure 4.34). Only
// three faces meet anywhere, so that the golden ratio does no harm. The corners of a
// plinth are objects, so that towers are a few spacings wide; their weight is low: long walls are
// likelier than corners.
continuous::Example make_pentagons() {
    continuous::Example example;
    example.name = "pentagons";
    example.title = "Pentagons";
    example.description = "Pentagonal towers that grow into each other.";
    example.materials = {
        {"paving", color(0x8C8478)},
        {"wall", color(0xC98A5B)},
        {"plinth", color(0xEBDDC3)},
        {"roof", color(0x2F6F73)}};
    example.objects = {{"paving", 0}, {"plinth", 2}, {"wall", 1}, {"roof", 3}};
    example.ground = kPaving;
    add_tower(example, {0, 0, 4, 1}, 2);
    add_tower(example, {4.5, 2, 3, -1}, 5);
    add_tower(example, {-5, 1.5, 3, -1}, 4);
    add_tower(example, {14, 0, 3, -1}, 2);
    example.dimensions = {{kPlinth, Point::UnitY()}, {kRoof, Point::UnitY()}};
    // One spacing wide across the normals of its two walls, and of no other.
    for (int side = 0; side < kSides; ++side) {
        example.objects.push_back({"corner " + std::to_string(side + 1), 2, 0.5});
        for (const int wall : {side, side + 1}) {
            const double angle = Pentagon{0, 0, 1, 1}.angle(wall);
            example.dimensions.push_back(
                {static_cast<ObjectId>(kCorner + side), {std::cos(angle), 0, -std::sin(angle)}}
            );
        }
    }
    example.spacing = 1;
    example.size = {34, 8, 34};
    example.density = 0.45;
    return example;
}

}  // namespace modelsynth::examples
