#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

namespace {

using continuous::ObjectId;
using continuous::Point;

// Steps that lead up different ways are different objects: so none leads nowhere.
enum : ObjectId { kFloor = 1, kWall, kEast, kWest, kSouth, kNorth, kLanding, kPost };

struct Plan {
    double x0, z0, x1, z1;
};

// Walls between y0 and y1 that carry a landing, and a post at each corner: three objects, so that
// none stands alone.
void add_landing(Blocks& blocks, const Plan& p, double y0, double y1) {
    blocks.add(kWall, {p.x0, y0, p.z0}, {p.x1, y1 - 1, p.z1});
    blocks.add(kLanding, {p.x0, y1 - 1, p.z0}, {p.x1, y1, p.z1});
    for (const bool east : {false, true}) {
        for (const bool south : {false, true}) {
            const double x = east ? p.x1 - 1 : p.x0;
            const double z = south ? p.z1 - 1 : p.z0;
            const auto post = static_cast<ObjectId>(kPost + (east ? 1 : 0) + (south ? 1 : 0));
            blocks.add(post, {x, y0, z}, {x + 1, y1, z + 1});
        }
    }
}

// Three steps from `foot`, which is the corner of the lowest one's floor; (dx, dz) is the way up.
void add_flight(Blocks& blocks, const Point& foot, int dx, int dz, double width) {
    const ObjectId object = dx > 0 ? kEast : dx < 0 ? kWest : dz > 0 ? kSouth : kNorth;
    const Point across = dx != 0 ? Point(1, 0, width) : Point(width, 0, 1);
    for (int step = 0; step < 3; ++step) {
        const Point corner = foot + step * Point(dx, 0, dz);
        if (step > 0) {
            blocks.add(kWall, corner, corner + across + step * Point::UnitY());
        }
        blocks.add(
            object, corner + step * Point::UnitY(), corner + across + (step + 1) * Point::UnitY()
        );
    }
}

}  // namespace

// Flights of steps between landings (thesis, Figure 4.33). A step is one spacing high and deep, and
// the wall under the next step stands at its back: so a flight that begins goes on to a landing.
continuous::Example make_stairs() {
    continuous::Example example;
    example.name = "stairs";
    example.title = "Stairs";
    example.description = "Flights of steps that climb from landing to landing.";
    example.materials = {
        {"floor", color(0x4F6A70)},
        {"wall", color(0xD8B183)},
        {"step", color(0xF2E6CE)},
        {"landing", color(0xB5533A)},
        {"post", color(0xC49A6C)}};
    example.objects = {
        {"floor", 0},
        {"wall", 1},
        {"step east", 2, 3},
        {"step west", 2, 3},
        {"step south", 2, 3},
        {"step north", 2, 3},
        {"landing", 3},
        {"post nw", 4},
        {"post", 4},
        {"post se", 4}};
    example.ground = kFloor;
    Blocks blocks;
    // At the post in the south-east there is always a flight, from the south or from the east; so
    // every landing can be reached.
    add_landing(blocks, {0, 0, 16, 16}, 0, 4);
    add_flight(blocks, {7, 0, -3}, 0, 1, 2);
    add_flight(blocks, {-3, 0, 7}, 1, 0, 2);
    add_flight(blocks, {18, 0, 7}, -1, 0, 2);
    add_flight(blocks, {13, 0, 18}, 0, -1, 2);
    add_landing(blocks, {5, 5, 11, 11}, 4, 8);
    add_flight(blocks, {2, 4, 7}, 1, 0, 2);
    add_flight(blocks, {7, 4, 2}, 0, 1, 2);
    add_flight(blocks, {13, 4, 8}, -1, 0, 2);
    add_flight(blocks, {7, 4, 13}, 0, -1, 2);
    blocks.append_to(example.polyhedra);
    example.dimensions = {
        {kEast, Point::UnitX()},
        {kWest, Point::UnitX()},
        {kSouth, Point::UnitZ()},
        {kNorth, Point::UnitZ()}};
    for (const ObjectId flat : {kEast, kWest, kSouth, kNorth, kLanding}) {
        example.dimensions.push_back({flat, Point::UnitY()});
    }
    for (const int corner : {0, 1, 2}) {
        const auto post = static_cast<ObjectId>(kPost + corner);
        example.dimensions.push_back({post, Point::UnitX()});
        example.dimensions.push_back({post, Point::UnitZ()});
    }
    example.spacing = 1;
    example.size = {40, 12, 40};
    example.density = 0.4;
    return example;
}

}  // namespace modelsynth::examples
