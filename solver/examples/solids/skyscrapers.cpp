#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/ornaments.h"
#include "solver/examples/solids/shapes.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

// Corners are objects of their own, opposite ones the same: so none stands alone, and buildings are
// three spacings wide at least. Their weight is low: long walls are likelier than corners.
enum : ObjectId {
    kStreet = 1,
    kStone,
    kSlab,
    kRibbon,
    kGlass,
    kPlant,
    kCap,
    kCrown,
    kPlinth,
    kPiers,
    kFeet = kPiers + 2
};

constexpr double kCornerWeight = 0.5;

struct Plan {
    double x0, z0, x1, z1;
};

// A plan without a square at each of its corners, from y0 to y1.
void add_body(Example& example, ObjectId body, const Plan& p, double y0, double y1) {
    const Outline outline = {
        {p.x0 + 1, -p.z1},
        {p.x1 - 1, -p.z1},
        {p.x1 - 1, -p.z1 + 1},
        {p.x1, -p.z1 + 1},
        {p.x1, -p.z0 - 1},
        {p.x1 - 1, -p.z0 - 1},
        {p.x1 - 1, -p.z0},
        {p.x0 + 1, -p.z0},
        {p.x0 + 1, -p.z0 - 1},
        {p.x0, -p.z0 - 1},
        {p.x0, -p.z1 + 1},
        {p.x0 + 1, -p.z1 + 1}};
    example.polyhedra.push_back(prism_upwards(body, outline, y0, y1));
}

void add_corners(Example& example, ObjectId first, const Plan& p, double y0, double y1) {
    for (const bool east : {false, true}) {
        for (const bool south : {false, true}) {
            const auto corner = static_cast<ObjectId>(first + (east != south ? 1 : 0));
            const double x = east ? p.x1 - 1 : p.x0;
            const double z = south ? p.z1 - 1 : p.z0;
            example.polyhedra.push_back(box(corner, {x, y0, z}, {x + 1, y1, z + 1}));
        }
    }
}

void add_box(Example& example, ObjectId object, const Plan& plan, double y0, double y1) {
    example.polyhedra.push_back(box(object, {plan.x0, y0, plan.z0}, {plan.x1, y1, plan.z1}));
}

// Caps and crowns have a low weight, so that towers are high.
void add_stone(Example& example, const Plan& plan, double y0, double y1) {
    add_body(example, kStone, plan, y0, y1);
    add_corners(example, kPiers, plan, y0, y1);
    add_box(example, kCap, plan, y1, y1 + 1);
}

// Storeys and glass have corners in a plinth only: what stands on it is as wide.
void add_plinth(Example& example, const Plan& plan, double y) {
    add_body(example, kPlinth, plan, y, y + 1);
    add_corners(example, kFeet, plan, y, y + 1);
}

void add_glass(Example& example, const Plan& plan, double y0, double y1) {
    add_plinth(example, plan, y0);
    add_box(example, kGlass, plan, y0 + 1, y1);
    add_box(example, kCrown, plan, y1, y1 + 1);
}

// A ribbon of windows and a slab for each storey.
void add_storeys(Example& example, const Plan& plan, double y0, int storeys) {
    add_plinth(example, plan, y0);
    for (int storey = 0; storey < storeys; ++storey) {
        const double y = y0 + 1 + 2 * storey;
        add_box(example, kRibbon, plan, y, y + 1);
        add_box(example, kSlab, plan, y + 1, y + 2);
    }
}

void add_corner_objects(Example& example, const std::string& name, std::uint32_t material) {
    for (const char* side : {" a", " b"}) {
        const auto object = static_cast<ObjectId>(example.objects.size() + 1);
        example.objects.push_back({name + side, material, kCornerWeight});
        example.dimensions.push_back({object, Point::UnitX()});
        example.dimensions.push_back({object, Point::UnitZ()});
    }
}

// Roofs and terraces end in parapets, those of stone in cornices with an obelisk at each corner.
void add_parapets(Example& example) {
    const std::vector<continuous::ProfilePoint> parapet = {
        {-0.1, 0.06}, {-0.1, -0.2}, {0.3, -0.2}, {0.3, 0.06}};
    const std::vector<continuous::ProfilePoint> cornice = {
        {-0.45, -0.1}, {0.12, -0.1}, {0.12, 0.32}, {-0.05, 0.32}, {-0.45, 0.06}};
    for (const ObjectId flat : {kSlab, kPlinth}) {
        example.objects[flat - 1].decorations = {moulding(kUp, kSide, parapet, kSlab)};
    }
    example.objects[kCrown - 1].decorations = {moulding(kUp, kSide, parapet, kCrown)};
    const continuous::Polyhedron obelisk =
        pyramid(kCap, {{-0.14, -0.14}, {0.14, -0.14}, {0.14, 0.14}, {-0.14, 0.14}}, 0, {0, 0.8, 0});
    example.objects[kCap - 1].decorations = {
        moulding(kUp, kSide, cornice, kCap),
        continuous::CornerDecoration{
            {kUp, kSide, kSide},
            continuous::Turn::kConvex,
            std::make_shared<continuous::Shape>(continuous::Shape{obelisk.corners, obelisk.faces}
            )}};
}

}  // namespace

// Three ways to build high: stone with piers at the corners, ribbons of windows between slabs, and
// glass. Towers stand on wider feet, flush with them and set back, for setbacks of every kind
// (thesis, Figure 4.28).
continuous::Example make_skyscrapers() {
    Example example;
    example.name = "skyscrapers";
    example.title = "Skyscrapers";
    example.description = "A downtown of stone, ribbon windows and glass, with wings and setbacks.";
    example.materials = {
        {"street", color(0x4A4D52)},
        {"stone", color(0x9C6240)},
        {"pier", color(0xD8B48C)},
        {"concrete", color(0xD9D4C7)},
        {"windows", color(0x2F4454), 0.2F, 0.35F},
        {"glass", color(0x3F7690), 0.3F, 0.3F},
        {"plant", color(0x3E464E)}};
    example.objects = {
        {"street", 0},
        {"stone", 1},
        {"slab", 3},
        {"ribbon", 4, 2.5},
        {"glass", 5},
        {"plant", 6},
        {"cap", 2, 0.4},
        {"crown", 6, 0.4},
        {"plinth", 3}};
    add_corner_objects(example, "pier", 2);
    add_corner_objects(example, "foot", 3);
    add_parapets(example);
    example.ground = kStreet;
    add_stone(example, {0, 0, 8, 8}, 0, 2);
    add_stone(example, {0, 0, 4, 4}, 3, 6);
    add_stone(example, {10, 0, 18, 8}, 0, 2);
    add_stone(example, {14, 4, 18, 8}, 3, 6);
    add_storeys(example, {0, 10, 8, 18}, 0, 1);
    add_storeys(example, {0, 14, 4, 18}, 3, 2);
    add_box(example, kPlant, {1, 15, 3, 17}, 8, 9);
    add_glass(example, {10, 10, 18, 18}, 0, 2);
    add_glass(example, {12, 12, 16, 16}, 3, 6);
    for (const ObjectId object : {kSlab, kRibbon, kPlant, kCap, kCrown, kPlinth}) {
        example.dimensions.push_back({object, Point::UnitY()});
    }
    example.spacing = 1;
    example.size = {48, 18, 48};
    return example;
}

}  // namespace modelsynth::examples
