#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

enum : ObjectId { kWater = 1, kSand, kRock, kTurf, kPeak };

struct Plan {
    double x0, z0, x1, z1;

    [[nodiscard]] Plan inner(double inset) const {
        return {x0 + inset, z0 + inset, x1 - inset, z1 - inset};
    }
};

// A layer one spacing high; its sides lean inwards at 45 degrees, or it is a cliff.
void add_slope(Example& example, ObjectId object, const Plan& p, double y) {
    example.polyhedra.push_back(tapered(object, {p.x0, y, p.z0}, {p.x1, y + 1, p.z1}, {1, 1, 1, 1})
    );
}

void add_cliff(Example& example, const Plan& p, double y) {
    example.polyhedra.push_back(box(kRock, {p.x0, y, p.z0}, {p.x1, y + 1, p.z1}));
}

// A cliff and the turf on it: the step of which all islands are made.
void add_terrace(Example& example, const Plan& plan, double y) {
    add_cliff(example, plan, y);
    add_slope(example, kTurf, plan, y + 1);
}

}  // namespace

// Islands of terraces: beaches, cliffs, green slopes over them, bare peaks (thesis, Figure 4.30).
// Every layer is one spacing high and grows narrower where it slopes, so heights need breadth.
// Where a slope begins at a cliff's edge three planes meet along a line, so that all of them stand
// on a grid.
continuous::Example make_terrain() {
    Example example;
    example.name = "terrain";
    example.title = "Rocky terrain";
    example.description = "Islands with beaches, cliffs and green terraces.";
    example.materials = {
        {"water", color(0x2F7C98), 0.1F, 0.3F},
        {"sand", color(0xE0C88F)},
        {"rock", color(0x7D7268)},
        {"turf", color(0x6F9444)},
        {"bare rock", color(0x9A9087)}};
    example.objects = {{"water", 0}, {"sand", 1}, {"rock", 2}, {"turf", 3}, {"peak", 4, 3}};
    example.ground = kWater;
    // An island in the shape of a cross, with terraces flush with the ends of two arms ...
    for (const Plan& arm : {Plan{0, 7, 22, 15}, Plan{7, 0, 15, 22}}) {
        add_slope(example, kSand, arm, 0);
        add_terrace(example, arm.inner(1), 1);
    }
    add_terrace(example, {2, 9, 8, 13}, 3);
    add_terrace(example, {9, 15, 13, 20}, 3);
    // ... and one of cliffs, with a terrace set back and one flush with the other sides.
    add_terrace(example, {26, 0, 42, 16}, 0);
    add_terrace(example, {30, 5, 41, 15}, 2);
    add_slope(example, kPeak, {33, 8, 38, 12}, 4);
    for (const ObjectId layer : {kSand, kRock, kTurf, kPeak}) {
        example.dimensions.push_back({layer, Point::UnitY()});
    }
    example.spacing = 1;
    example.size = {48, 9, 48};
    example.density = 0.5;
    return example;
}

}  // namespace modelsynth::examples
