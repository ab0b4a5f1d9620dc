#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/ornaments.h"
#include "solver/examples/solids/shapes.h"

#include <vector>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

// A storey is two layers, each one spacing high and an object of its own, so that no house grows
// higher than the example's and windows stand in rows.
enum : ObjectId {
    kGrass = 1,
    kPlinth,
    kStone,
    kSill,
    kPlaster,
    kAttic,
    kRoof,
    kWindow,
    kDoor,
    kChimney,
    kPot,
    kCornerA,
    kCornerB
};

constexpr ObjectId kLayers[] = {kPlinth, kStone, kSill, kPlaster};

enum class Ridge { kAlongX, kAlongZ };

struct Wing {
    double x0, z0, x1, z1;
    int storeys;
    Ridge ridge;
    // How far the roof goes on beyond either end, into another roof.
    double before = 0;
    double after = 0;
};

void add_walls(Blocks& blocks, const Wing& wing) {
    for (int layer = 0; layer < 2 * wing.storeys; ++layer) {
        const double y = layer;
        blocks.add(kLayers[layer], {wing.x0, y, wing.z0}, {wing.x1, y + 1, wing.z1});
    }
}

// The corners of a plinth are objects, opposite ones the same: so none stands alone, and a house
// has room for a door. Their weight is low: long walls are likelier than corners.
void add_corner_stones(Blocks& blocks, const Wing& wing) {
    for (const bool east : {false, true}) {
        for (const bool south : {false, true}) {
            const bool is_inside = wing.ridge == Ridge::kAlongX
                                       ? (east ? wing.after : wing.before) > 0
                                       : (south ? wing.after : wing.before) > 0;
            const double x = east ? wing.x1 - 1 : wing.x0;
            const double z = south ? wing.z1 - 1 : wing.z0;
            if (!is_inside) {
                blocks.add(east == south ? kCornerA : kCornerB, {x, 0, z}, {x + 1, 1, z + 1});
            }
        }
    }
}

// Tiles over an attic that shows in the gables.
void add_roof(Example& example, const Wing& wing, ObjectId object, double inset) {
    const double y = 2 * wing.storeys;
    const auto gable = [&](double a, double b) {
        return Outline{{a + inset, y}, {b - inset, y}, {(a + b) / 2, y + (b - a) / 2 - inset}};
    };
    example.polyhedra.push_back(
        wing.ridge == Ridge::kAlongZ
            ? prism_along_z(
                  object, gable(wing.x0, wing.x1), wing.z0 - wing.before, wing.z1 + wing.after
              )
            : prism_along_x(
                  object, gable(wing.z0, wing.z1), wing.x0 - wing.before, wing.x1 + wing.after
              )
    );
}

// Ridges and the verges of gables, posts at the corners of upper storeys, and rims of pots.
void add_woodwork(Example& example) {
    example.objects[kRoof - 1].decorations = {
        moulding(kSlope, kSlope, bar(0.08, 0.25), kRoof),
        moulding(kSlope, kSide, {{0.06, -0.1}, {0.06, 0.22}, {-0.22, 0.22}, {-0.22, -0.1}}, kDoor)};
    for (const ObjectId storey : {kSill, kPlaster}) {
        example.objects[storey - 1].decorations = {moulding(kSide, kSide, bar(0.05, 0.22), kDoor)};
    }
    example.objects[kPot - 1].decorations = {
        moulding(kUp, kSide, {{0.1, -0.2}, {0.1, 0.1}, {-0.15, 0.1}, {-0.15, -0.2}}, kChimney)};
}

}  // namespace

// Gabled wings of one and two storeys that meet at right angles: from these come T-shaped, L-shaped
// and crossing houses of any size (thesis, Figure 4.32).
continuous::Example make_houses() {
    Example example;
    example.name = "houses";
    example.title = "Houses";
    example.description = "Gabled wings of one or two storeys whose roofs join as roofs do.";
    example.materials = {
        {"grass", color(0x6F9148)},
        {"stone", color(0xA79B8B)},
        {"plaster", color(0xEADFC8)},
        {"tiles", color(0xA6492F)},
        {"glass", color(0x2E3E4C)},
        {"wood", color(0x6B4226)},
        {"brick", color(0x8C5A45)}};
    example.objects = {
        {"grass", 0},
        {"plinth", 1},
        {"stone", 1},
        {"sill", 2},
        {"plaster", 2},
        {"attic", 2},
        {"roof", 3},
        {"window", 4, 3},
        {"door", 5},
        {"chimney", 6},
        {"pot", 5},
        {"corner a", 1, 0.6},
        {"corner b", 1, 0.6}};
    add_woodwork(example);
    example.ground = kGrass;
    const std::vector<Wing> wings = {// A cross of two storeys.
                                     {6, 0, 10, 16, 2, Ridge::kAlongZ},
                                     {0, 6, 6, 10, 2, Ridge::kAlongX, 0, 2},
                                     {10, 6, 16, 10, 2, Ridge::kAlongX, 2, 0},
                                     // One of one storey.
                                     {20, 6, 36, 10, 1, Ridge::kAlongX},
                                     {26, 0, 30, 6, 1, Ridge::kAlongZ, 0, 2},
                                     {26, 10, 30, 16, 1, Ridge::kAlongZ, 2, 0}};
    Blocks blocks;
    for (const Wing& wing : wings) {
        add_walls(blocks, wing);
    }
    for (const Wing& wing : wings) {
        add_corner_stones(blocks, wing);
    }
    // Doors and windows in each of the four walls' directions.
    const auto window = [&](double x, double y, double z) {
        blocks.add(kWindow, {x, y, z}, {x + 1, y + 1, z + 1});
    };
    const auto door = [&](double x, double z) { blocks.add(kDoor, {x, 0, z}, {x + 1, 2, z + 1}); };
    for (const double y : {1.0, 3.0}) {
        window(8, y, 0);
        window(8, y, 15);
        window(0, y, 8);
        window(15, y, 8);
        for (const double x : {2.0, 13.0}) {
            window(x, y, 6);
            window(x, y, 9);
        }
        for (const double z : {2.0, 13.0}) {
            window(6, y, z);
            window(9, y, z);
        }
    }
    door(3, 6);
    door(12, 9);
    door(6, 11);
    door(9, 4);
    window(27, 1, 0);
    window(27, 1, 15);
    window(20, 1, 7);
    window(35, 1, 7);
    window(22, 1, 6);
    window(22, 1, 9);
    window(26, 1, 2);
    window(29, 1, 2);
    door(24, 6);
    door(24, 9);
    door(26, 4);
    door(29, 4);
    blocks.append_to(example.polyhedra);
    for (const Wing& wing : wings) {
        add_roof(example, wing, kRoof, 0);
    }
    for (const Wing& wing : wings) {
        add_roof(example, wing, kAttic, 1);
    }
    // A chimney next to the ridge of either direction.
    for (const Point& foot : {Point(7, 5, 12), Point(2, 5, 8)}) {
        example.polyhedra.push_back(box(kChimney, foot, foot + Point(1, 1, 1)));
        example.polyhedra.push_back(box(kPot, foot + Point(0, 1, 0), foot + Point(1, 2, 1)));
    }
    for (const ObjectId layer : kLayers) {
        example.dimensions.push_back({layer, Point::UnitY()});
    }
    example.dimensions.push_back({kChimney, Point::UnitY()});
    example.dimensions.push_back({kPot, Point::UnitY()});
    for (const ObjectId cube : {kWindow, kDoor, kChimney, kPot, kCornerA, kCornerB}) {
        example.dimensions.push_back({cube, Point::UnitX()});
        example.dimensions.push_back({cube, Point::UnitZ()});
    }
    example.spacing = 1;
    example.size = {36, 10, 36};
    example.density = 0.25;
    return example;
}

}  // namespace modelsynth::examples
