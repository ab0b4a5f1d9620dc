#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/ornaments.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

// Opposite quoins are the same object: so none stands alone, and buildings are as wide as three
// spacings at least. Their weight is low: long walls are likelier than corners.
enum : ObjectId { kPaving = 1, kWall, kCornice, kRoof, kWindow, kQuoinA, kQuoinB };

struct Plan {
    double x0, z0, x1, z1;
};

void add_walls(Blocks& blocks, const Plan& p, double y0, double y1) {
    blocks.add(kWall, {p.x0, y0, p.z0}, {p.x1, y1, p.z1});
    for (const bool east : {false, true}) {
        for (const bool south : {false, true}) {
            const double x = east ? p.x1 - 1 : p.x0;
            const double z = south ? p.z1 - 1 : p.z0;
            blocks.add(east == south ? kQuoinA : kQuoinB, {x, y0, z}, {x + 1, y1, z + 1});
        }
    }
}

}  // namespace

// Hipped and pyramid roofs: four and more faces meet in a point wherever a roof comes to one or
// its corner stands on a wall's (thesis, Figure 4.36).
continuous::Example make_buildings() {
    Example example;
    example.name = "buildings";
    example.title = "Buildings";
    example.description = "Halls and towers under hipped and pyramid roofs.";
    example.materials = {
        {"paving", color(0x9C9484)},
        {"brick", color(0xB0603F)},
        {"limestone", color(0xE9DEC6)},
        {"copper", color(0x3F7F72)},
        {"glass", color(0x2B3B45), 0.1F, 0.4F}};
    example.objects = {
        {"paving", 0},
        {"wall", 1},
        {"cornice", 2},
        {"roof", 3},
        {"window", 4, 4},
        {"quoin a", 2, 0.5},
        {"quoin b", 2, 0.5}};
    example.ground = kPaving;
    // Tiles on hips and ridges, and a finial wherever a roof comes to a point.
    example.objects[kRoof - 1].decorations = {
        moulding(kSlope, kSlope, bar(0.06, 0.06), kCornice),
        continuous::CornerDecoration{
            {kSlope, kSlope, kSlope}, continuous::Turn::kConvex, finial(0.6), false, kCornice}};
    Blocks blocks;
    const auto building = [&](const Plan& p, double y0, double y1) {
        add_walls(blocks, p, y0, y1 - 1);
        blocks.add(kCornice, {p.x0, y1 - 1, p.z0}, {p.x1, y1, p.z1});
        example.polyhedra.push_back(hip_roof(kRoof, {p.x0, y1, p.z0}, {p.x1, 0, p.z1}));
    };
    // Two halls, one each way, with windows in each of the four walls' directions.
    building({0, 0, 6, 12}, 0, 4);
    building({8, 0, 20, 6}, 0, 4);
    for (const double x : {0.0, 5.0}) {
        blocks.add(kWindow, {x, 1, 2}, {x + 1, 2, 3});
        blocks.add(kWindow, {x, 1, 5}, {x + 1, 2, 6});
    }
    for (const double z : {0.0, 5.0}) {
        blocks.add(kWindow, {10, 1, z}, {11, 2, z + 1});
        blocks.add(kWindow, {13, 1, z}, {14, 2, z + 1});
    }
    // A hall with a tower at its end, and a tower that rises out of a roof.
    building({8, 8, 18, 12}, 0, 3);
    building({18, 8, 22, 12}, 0, 6);
    building({0, 14, 10, 24}, 0, 3);
    building({3, 17, 7, 21}, 3, 8);
    example.dimensions = {{kCornice, Point::UnitY()}};
    for (const ObjectId narrow : {kQuoinA, kQuoinB, kWindow}) {
        example.dimensions.push_back({narrow, Point::UnitX()});
        example.dimensions.push_back({narrow, Point::UnitZ()});
    }
    blocks.append_to(example.polyhedra);
    example.spacing = 1;
    example.size = {36, 10, 36};
    return example;
}

}  // namespace modelsynth::examples
