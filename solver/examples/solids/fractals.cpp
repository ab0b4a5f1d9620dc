#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

#include <array>

namespace modelsynth::examples {

namespace {

using continuous::ObjectId;
using continuous::Point;
using continuous::Polyhedron;

constexpr std::array<std::array<double, 3>, 4> kCorners = {
    {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}};

Polyhedron tetrahedron(ObjectId object, const Point& at, double size) {
    Polyhedron solid;
    solid.object = object;
    for (const auto& [x, y, z] : kCorners) {
        solid.corners.push_back(at + size * Point(x, y, z));
    }
    solid.faces = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return solid;
}

}  // namespace

// The first step of a Sierpinski tetrahedron: four tetrahedra that touch at their corners (thesis,
// Figure 4.29).
continuous::Example make_fractals() {
    enum : ObjectId { kFirst = 1 };

    continuous::Example example;
    example.name = "fractals";
    example.title = "Fractals";
    example.description = "Tetrahedra that touch at their corners, as in Sierpinski's.";
    example.materials = {
        {"gold", color(0xE0A63A)},
        {"coral", color(0xD65A4A)},
        {"teal", color(0x2F8F8B)},
        {"indigo", color(0x3C4A8C)}};
    example.objects = {{"gold", 0}, {"coral", 1}, {"teal", 2}, {"indigo", 3}};
    for (ObjectId i = 0; i < 4; ++i) {
        const auto& [x, y, z] = kCorners[i];
        example.polyhedra.push_back(
            tetrahedron(static_cast<ObjectId>(kFirst + i), 2 * Point(x, y, z), 2)
        );
    }
    example.spacing = 1;
    example.size = {16, 16, 16};
    return example;
}

}  // namespace modelsynth::examples
