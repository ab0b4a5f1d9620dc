#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

#include <initializer_list>
#include <utility>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;
using continuous::Polyhedron;

enum : ObjectId {
    kHull = 1,
    kUpperEast,
    kUpperWest,
    kLower,
    kNose,
    kBeam,
    kEngine,
    kFlame,
    kFin,
    kBridge
};

enum : std::uint32_t { kGrey, kWhite, kDark, kOrange, kSteel, kIron, kGlow, kRed, kGlass };

void add(Example& example, ObjectId object, const Point& min, const Point& max) {
    example.polyhedra.push_back(box(object, min, max));
}

// All ships fly south, +z. A plate with a sharp bow and engines astern.
void add_plate(
    Example& example,
    const Point& at,
    double width,
    double length,
    std::initializer_list<double> engines
) {
    const double x = at.x();
    const double y = at.y();
    const double z = at.z();
    const double bow = z + length;
    add(example, kHull, at, {x + width, y + 1, bow});
    example.polyhedra.push_back(
        prism_along_x(kNose, {{bow, y}, {bow + 0.5, y + 0.5}, {bow, y + 1}}, x, x + width)
    );
    for (const double engine : engines) {
        add(example, kEngine, {x + engine, y, z - 1}, {x + engine + 1, y + 1, z});
        example.polyhedra.push_back(prism_along_x(
            kFlame, {{z - 1, y}, {z - 1, y + 1}, {z - 1.5, y + 0.5}}, x + engine, x + engine + 1
        ));
    }
}

// Sloping armour over or under a plate: it leans in by as much as it is high, but not astern.
void add_armour(
    Example& example, ObjectId object, const Point& min, const Point& max, double west, double east
) {
    const bool is_upper = object != kLower;
    Polyhedron armour = box(object, min, max);
    for (Point& corner : armour.corners) {
        if (corner.y() == (is_upper ? max : min).y()) {
            corner.x() += corner.x() == min.x() ? west : -east;
            corner.z() -= corner.z() == min.z() ? 0 : 1;
        }
    }
    example.polyhedra.push_back(std::move(armour));
}

void add_sloping_along_x(Example& example, ObjectId object, const Point& min, const Point& max) {
    const double slope = max.y() - min.y();
    const Outline side = {
        {min.z(), min.y()}, {max.z(), min.y()}, {max.z() - slope, max.y()}, {min.z(), max.y()}};
    example.polyhedra.push_back(prism_along_x(object, side, min.x(), max.x()));
}

}  // namespace

// Hulls, beams with gaps between them, engines of one size (thesis, Figure 4.37).
Example make_spaceships() {
    Example example;
    example.name = "spaceships";
    example.title = "Spaceships";
    example.description =
        "A fleet on one course: armoured hulls, outriggers on beams, engines, fins.";
    example.materials = {
        {"hull", color(0xA9B1BA), 0.2F, 0.55F},
        {"armour", color(0xE8EAEC), 0.1F, 0.5F},
        {"belly", color(0x5F6873), 0.2F, 0.6F},
        {"bow", color(0xE8842C), 0, 0.5F},
        {"beams", color(0x7C8792), 0.3F, 0.5F},
        {"engines", color(0x3F464E), 0.3F, 0.5F},
        {"flame", color(0xBFF4FF), 0, 0.5F, color(0x49D3FF)},
        {"fins", color(0xC33B32), 0, 0.5F},
        {"glass", color(0x2B5F8A), 0.1F, 0.2F, color(0x123A5C)}};
    example.objects = {
        {"hull", kGrey, 3},
        {"upper armour east", kWhite, 2},
        {"upper armour west", kWhite, 2},
        {"lower armour", kDark, 2},
        {"bow", kOrange, 0.4},
        {"beam", kSteel, 12},
        {"engine", kIron, 1},
        {"flame", kGlow, 1},
        {"fin", kRed, 0.5},
        {"bridge", kGlass, 4}};

    const Point middle(0, 3, 0);
    add_plate(example, middle, 6, 12, {1, 4});
    // In two halves that need each other: no ship is narrower than both.
    add_armour(example, kUpperWest, {0, 4, 0}, {3, 5, 12}, 1, 0);
    add_armour(example, kUpperEast, {3, 4, 0}, {6, 5, 12}, 0, 1);
    add_armour(example, kLower, {0, 2, 0}, {6, 3, 12}, 1, 1);
    add_sloping_along_x(example, kBridge, {2, 5, 3}, {4, 6, 7});
    for (const double x : {-5.0, 9.0}) {
        add_plate(example, {x, 3, 1}, 2, 9, {0});
        const double beam = x < 0 ? x + 2 : 6;
        add(example, kBeam, {beam, 3, 3}, {beam + 3, 4, 4});
        add(example, kBeam, {beam, 3, 7}, {beam + 3, 4, 8});
        const double fin = x < 0 ? x : x + 1;
        add_sloping_along_x(example, kFin, {fin, 4, 1}, {fin + 1, 6, 6});
    }

    const Point x = Point::UnitX();
    const Point y = Point::UnitY();
    const Point z = Point::UnitZ();
    example.dimensions = {
        {kHull, y},
        {kUpperEast, y},
        {kUpperWest, y},
        {kLower, y},
        {kNose, y},
        {kBeam, y},
        {kBeam, z},
        {kEngine, x},
        {kEngine, y},
        {kEngine, z},
        {kFlame, x},
        {kFlame, y},
        {kFin, x},
        {kBridge, y}};
    std::vector<ObjectId>& ship = example.connected.emplace_back();
    for (int object = kHull; object <= kBridge; ++object) {
        ship.push_back(static_cast<ObjectId>(object));
    }
    example.spacing = 1;
    example.size = {40, 12, 40};
    example.density = 0.06;
    return example;
}

}  // namespace modelsynth::examples
