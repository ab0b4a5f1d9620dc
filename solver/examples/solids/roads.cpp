#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "solver/examples/solids/turned.h"

#include <string>
#include <vector>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

enum : ObjectId {
    kGrass = 1,
    kWall,
    kRoof,
    kTree,
    kTreeTop,
    kAlongX,
    kAlongZ,
    kBend,
    kFork = kBend + 4,
    kCrossing = kFork + 4
};

enum : std::uint32_t { kMeadow, kPlaster, kTiles, kLeaves, kNeedles, kAsphalt, kPatched };

constexpr double kUnit = 3;

// Slopes rise one in three: those of the roofs, and those of the roads' beds.
constexpr double kRise = 1.0 / 3;

// A road lies flush in the ground, in a bed that is as deep as the model's box goes below it: its
// sides slope down to the middle.
void lay_along_x(Example& example, double x0, double x1, double z) {
    const Outline bed = {
        {kUnit * (z + 0.5), -kUnit * kRise / 2}, {kUnit * (z + 1), 0}, {kUnit * z, 0}};
    example.polyhedra.push_back(prism_along_x(kAlongX, bed, kUnit * x0, kUnit * x1));
}

void lay_along_z(Example& example, double x, double z0, double z1) {
    const Outline bed = {
        {kUnit * (x + 0.5), -kUnit * kRise / 2}, {kUnit * (x + 1), 0}, {kUnit * x, 0}};
    example.polyhedra.push_back(prism_along_z(kAlongZ, bed, kUnit * z0, kUnit * z1));
}

void lay_junction(Example& example, int kind, double x, double z) {
    const double u = kUnit;
    const Outline downwards = {{0, 0}, {0, u}, {u, u}, {u, 0}};
    const Point lowest(u / 2, -u * kRise / 2, -u / 2);
    example.polyhedra.push_back(moved(
        pyramid(static_cast<ObjectId>(kind), downwards, 0, lowest), Point(u * x, 0, u * (z + 1))
    ));
}

// One object per kind of junction and direction: with a single one for all of them a road could
// begin at one kind and end at another, and there would be dead ends.
void lay_roads(Example& example) {
    // A ring with a cross in it has every junction in every direction. Roads begin at 0, 6 and 12.
    constexpr double kArm = 6;
    for (int row = 0; row < 3; ++row) {
        for (int i = 0; i < 2; ++i) {
            const double begin = i * kArm + 1;
            const double end = begin + kArm - 1;
            lay_along_x(example, begin, end, row * kArm);
            lay_along_z(example, row * kArm, begin, end);
        }
    }
    for (int turn = 0; turn < 4; ++turn) {
        const Point corner = turned(Point(1, 0, 1), turn);
        const Point side = turned(Point(1, 0, 0), turn);
        lay_junction(example, kBend + turn, kArm * (1 + corner.x()), kArm * (1 + corner.z()));
        lay_junction(example, kFork + turn, kArm * (1 + side.x()), kArm * (1 + side.z()));
    }
    lay_junction(example, kCrossing, kArm, kArm);
}

void build_house(Example& example, double x, double z, double width, double depth) {
    example.polyhedra.push_back(
        box(kWall, kUnit * Point(x, 0, z), kUnit * Point(x + width, 1, z + depth))
    );
    const double u = kUnit;
    if (width > depth) {
        example.polyhedra.push_back(prism_along_x(
            kRoof,
            {{u * z, u}, {u * (z + depth), u}, {u * (z + depth / 2), u * (1 + depth / 2 * kRise)}},
            u * x,
            u * (x + width)
        ));
    } else {
        example.polyhedra.push_back(prism_along_z(
            kRoof,
            {{u * x, u}, {u * (x + width), u}, {u * (x + width / 2), u * (1 + width / 2 * kRise)}},
            u * z,
            u * (z + depth)
        ));
    }
}

void plant_tree(Example& example, double x, double z) {
    const Point foot = kUnit * Point(x, 0, z);
    const double u = kUnit;
    example.polyhedra.push_back(box(kTree, foot, foot + Point(u, u, u)));
    example.polyhedra.push_back(moved(
        pyramid(
            kTreeTop, {{0, -u}, {u, -u}, {u, 0}, {0, 0}}, 0, Point(u / 2, u / 2 * kRise, u / 2)
        ),
        foot + Point(0, u, 0)
    ));
}

}  // namespace

// Lanes one spacing wide that never end: straight on, bends, forks and crossings (thesis, Figure
// 4.38), and between them houses and trees.
Example make_roads() {
    Example example;
    example.name = "roads";
    example.title = "Roads";
    example.description =
        "Lanes of one width that bend, fork and cross and never end, with houses and trees "
        "between.";
    example.materials = {
        {"meadow", color(0x86A653)},
        {"plaster", color(0xEFE3CB)},
        {"tiles", color(0xB5512F)},
        {"leaves", color(0x3E6B35)},
        {"needles", color(0x4F8040)},
        {"asphalt", color(0x56585C)},
        {"patched asphalt", color(0x66686B)}};
    example.objects = {
        {"meadow", kMeadow, 0},
        {"wall", kPlaster, 1},
        {"roof", kTiles, 1},
        {"tree", kLeaves, 1},
        {"treetop", kNeedles, 1},
        {"road east-west", kAsphalt, 1},
        {"road north-south", kAsphalt, 1}};
    for (const char* kind : {"bend", "fork"}) {
        for (int turn = 0; turn < 4; ++turn) {
            example.objects.push_back(
                {kind + std::string(" ") + std::to_string(turn + 1), kPatched, 1}
            );
        }
    }
    example.objects.push_back({"crossing", kPatched, 1});
    // Long lanes with few junctions, since the net goes wherever it can.
    const auto weigh = [&](int from, int to, double weight) {
        for (int object = from; object <= to; ++object) {
            example.objects[static_cast<std::size_t>(object) - 1].weight = weight;
        }
    };
    weigh(kWall, kRoof, 0.7);
    weigh(kTree, kTreeTop, 0.7);
    weigh(kAlongX, kAlongZ, 200);
    weigh(kBend, kBend + 3, 1.5);
    weigh(kFork, kFork + 3, 1);
    weigh(kCrossing, kCrossing, 0.5);
    example.ground = kGrass;

    lay_roads(example);
    build_house(example, 2, 2, 3, 2);
    build_house(example, 8, 2, 2, 3);
    plant_tree(example, 3, 9);
    plant_tree(example, 9, 9);

    const Point across_x = Point::UnitX();
    const Point across_z = Point::UnitZ();
    example.dimensions = {
        {kAlongX, across_z}, {kAlongZ, across_x}, {kTree, across_x}, {kTree, across_z}};
    for (int kind = kBend; kind <= kCrossing; ++kind) {
        example.dimensions.push_back({static_cast<ObjectId>(kind), across_x});
        example.dimensions.push_back({static_cast<ObjectId>(kind), across_z});
    }
    std::vector<ObjectId>& network = example.connected.emplace_back();
    for (int road = kAlongX; road <= kCrossing; ++road) {
        network.push_back(static_cast<ObjectId>(road));
    }
    example.spacing = kUnit;
    example.density = 0.9;
    example.size = {120, 9, 120};
    return example;
}

}  // namespace modelsynth::examples
