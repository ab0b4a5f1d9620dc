#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace modelsynth::examples {

namespace {

using continuous::ObjectId;
using continuous::Point;
using continuous::Polyhedron;

// Corners of a regular tetrahedron that stands on a face and is 1 high.
const std::array<Point, 4>& corners() {
    static const double edge = std::sqrt(1.5);
    static const std::array<Point, 4> at = {
        Point(0, 0, 0),
        Point(edge, 0, 0),
        Point(edge / 2, 0, edge * std::sqrt(0.75)),
        Point(edge / 2, 1, edge * std::sqrt(0.75) / 3)};
    return at;
}

Polyhedron tetrahedron(ObjectId object, const Point& at, double height) {
    Polyhedron solid;
    solid.object = object;
    for (const Point& corner : corners()) {
        solid.corners.push_back(at + height * corner);
    }
    solid.faces = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return solid;
}

}  // namespace

// Two steps of a Sierpinski tetrahedron: tetrahedra that touch at their corners (thesis, Figure
// 4.29). All four planes meet where two of them touch. The colour tells the place within four: so
// they come in fours, and a four ends, or touches another one, at its own corners.
continuous::Example make_fractals() {
    continuous::Example example;
    example.name = "fractals";
    example.title = "Fractals";
    example.description = "Tetrahedra that touch at their corners, as in Sierpinski's.";
    example.materials = {
        {"gold", color(0xE0A63A)},
        {"coral", color(0xD65A4A)},
        {"teal", color(0x2F8F8B)},
        {"indigo", color(0x3C4A8C)}};
    example.objects = {{"gold", 0, 2}, {"coral", 1, 2}, {"teal", 2, 2}, {"indigo", 3, 2}};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const auto object = static_cast<ObjectId>(1 + j);
            example.polyhedra.push_back(tetrahedron(object, 2 * corners()[i] + corners()[j], 1));
        }
    }
    example.spacing = 1;
    example.size = {20, 20, 20};
    example.density = 0.2;
    return example;
}

}  // namespace modelsynth::examples
