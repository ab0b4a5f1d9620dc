#include "solver/continuous/shapes/cut_boxes.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/lathe.h"
#include "solver/examples/solids/ornaments.h"
#include "solver/examples/solids/shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

enum : ObjectId { kSand = 1, kTerrace, kHall, kQuoinA, kQuoinB, kCornice, kDrum, kDome, kTower };

enum : std::uint32_t { kGround, kStone, kPlaster, kQuoins, kTrim, kTurquoise, kBrick };

constexpr std::uint32_t kSegments = 24;

// A pointed shell on a lip, with a finial: as high as half of its width.
std::vector<std::array<double, 2>> dome_outline() {
    std::vector<std::array<double, 2>> outline = {{0, 0}, {1, 0}, {1, 0.05}, {0.93, 0.07}};
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = std::numbers::pi / 2 * i / kSteps;
        outline.push_back({0.93 * std::pow(std::cos(angle), 0.85), 0.1 + 0.72 * std::sin(angle)});
    }
    outline.insert(outline.end(), {{0.05, 0.84}, {0.07, 0.88}, {0.03, 0.91}, {0, 1}});
    return outline;
}

// A shaft on a foot, with a ring below its top.
constexpr std::array<std::array<double, 2>, 8> kTowerOutline = {
    {{0, 0}, {1, 0}, {1, 0.07}, {0.86, 0.1}, {0.82, 0.9}, {0.96, 0.93}, {0.96, 1}, {0, 1}}};

void add(Example& example, ObjectId object, const Point& min, const Point& max) {
    example.polyhedra.push_back(box(object, min, max));
}

// A drum and the dome on it.
void add_dome(Example& example, const Point& at, double width) {
    add(example, kDrum, at, at + Point(width, 1, width));
    add(example, kDome, at + Point(0, 1, 0), at + Point(width, 1 + width / 2, width));
}

// A round tower with a dome for a roof.
void add_tower(Example& example, const Point& at, double width, double height) {
    add(example, kTower, at, at + Point(width, height, width));
    add(example, kDome, at + Point(0, height, 0), at + Point(width, height + width / 2, width));
}

// Walls between two heights, with a cornice on top. Quoins of one kind are in want of those of the
// other, which keeps halls wider than the quoins are.
void add_hall(Blocks& blocks, const Point& min, const Point& max) {
    blocks.add(kHall, min, max - Point(0, 1, 0));
    for (int corner = 0; corner < 4; ++corner) {
        const double x = corner % 2 == 0 ? min.x() : max.x() - 1;
        const double z = corner / 2 == 0 ? min.z() : max.z() - 1;
        const ObjectId quoin = corner == 0 || corner == 3 ? kQuoinA : kQuoinB;
        blocks.add(quoin, {x, min.y(), z}, {x + 1, max.y() - 1, z + 1});
    }
    blocks.add(kCornice, {min.x(), max.y() - 1, min.z()}, max);
}

}  // namespace

// Halls under domes, and round towers: what is round stands in for boxes that are cut so that they
// grow evenly (thesis, Figures 4.27 and 4.32).
Example make_domes() {
    Example example;
    example.name = "domes";
    example.title = "Domes and cylinders";
    example.description =
        "Halls with turquoise domes and round towers on stone terraces, all of them true to shape.";
    example.materials = {
        {"sand", color(0xD9BE8C), 0, 0.95F},
        {"terrace", color(0xB79B72), 0, 0.9F},
        {"plaster", color(0xEFE3CB), 0, 0.85F},
        {"quoins", color(0xC9A86F), 0, 0.85F},
        {"cornice", color(0x3E6FA3), 0, 0.7F},
        {"domes", color(0x2FA6A0), 0.1F, 0.35F},
        {"brick", color(0xC98B5E), 0, 0.85F}};
    example.objects = {
        {"sand", kGround, 0},
        {"terrace", kStone, 0.4},
        {"hall", kPlaster, 1},
        {"quoin a", kQuoins, 0.5},
        {"quoin b", kQuoins, 0.5},
        {"cornice", kTrim, 1},
        {"drum", kPlaster, 3},
        {"dome", kTurquoise, 1, lathe(dome_outline(), kSegments, {true, true, true})},
        {"tower", kBrick, 1, lathe(kTowerOutline, kSegments, {true, false, true})}};
    example.ground = kSand;
    // A moulding round flat roofs, with a pinnacle at each of their corners.
    example.objects[kCornice - 1].decorations = {
        moulding(
            kUp, kSide, {{-0.3, -0.1}, {0.15, -0.1}, {0.15, 0.2}, {0, 0.2}, {-0.3, 0.05}}, kCornice
        ),
        continuous::CornerDecoration{
            {kUp, kSide, kSide}, continuous::Turn::kConvex, finial(1), false, kTerrace}};
    example.objects[kTerrace - 1].decorations = {moulding(kUp, kSide, bar(0.06, 0.3), kQuoinA)};

    Blocks halls;
    // A hall under one large dome, with a tower at two corners of its terrace.
    halls.add(kTerrace, {0, 0, 0}, {16, 1, 14});
    add_hall(halls, {4, 1, 3}, {12, 4, 11});
    add_dome(example, {6, 4, 5}, 4);
    add_tower(example, {1, 1, 1}, 2, 6);
    add_tower(example, {13, 1, 11}, 2, 6);
    // One in the shape of a cross, with a dome over its middle, on the ground.
    add_hall(halls, {24, 0, 2}, {28, 3, 14});
    add_hall(halls, {20, 0, 6}, {32, 3, 10});
    add_dome(example, {24, 3, 6}, 4);
    // A hall of two storeys with small domes.
    add_hall(halls, {0, 0, 20}, {12, 3, 28});
    add_hall(halls, {2, 3, 22}, {7, 5, 27});
    add_dome(example, {8, 3, 23}, 2);
    add_dome(example, {4, 5, 24}, 2);
    // A thick tower by itself.
    add_tower(example, {20, 0, 20}, 4, 5);
    halls.append_to(example.polyhedra);

    const Point x = Point::UnitX();
    const Point y = Point::UnitY();
    const Point z = Point::UnitZ();
    example.dimensions = {
        {kTerrace, y},
        {kCornice, y},
        {kDrum, y},
        {kQuoinA, x},
        {kQuoinA, z},
        {kQuoinB, x},
        {kQuoinB, z}};
    example.spacing = 1;
    example.density = 0.25;
    example.size = {36, 11, 36};
    continuous::cut_boxes(example);
    return example;
}

}  // namespace modelsynth::examples
