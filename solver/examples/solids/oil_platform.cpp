#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "solver/examples/solids/turned.h"

#include <string>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

enum : ObjectId {
    kSea = 1,
    kLeg,  // by the corner of the deck under which it stands
    kBeamX = kLeg + 4,
    kBeamZ,
    kDeck,
    kCabin,
    kBridge,
    kPad,
    kDerrick,
    kTip,
    kMast,
    kJib,
    kEnd = kJib + 4
};

enum : std::uint32_t { kWater, kSteel, kBrace, kPlating, kWhite, kGreen, kRed, kYellow, kLight };

void add(Example& example, ObjectId object, const Point& min, const Point& max) {
    example.polyhedra.push_back(box(object, min, max));
}

// A deck with its corners on legs: legs further in would allow a deck without any, in the air. Legs
// are objects of their own for each corner: else one could stand under two at once, and there would
// be decks that are no wider than a leg.
void add_deck(Example& example, const Point& min, const Point& max) {
    for (int corner = 0; corner < 4; ++corner) {
        const double x = corner % 2 == 0 ? min.x() : max.x() - 1;
        const double z = corner / 2 == 0 ? min.z() : max.z() - 1;
        const auto leg = static_cast<ObjectId>(kLeg + corner);
        add(example, leg, {x, min.y(), z}, {x + 1, max.y() - 1, z + 1});
    }
    add(example, kDeck, {min.x(), max.y() - 1, min.z()}, max);
}

// Beams all round, from leg to leg.
void add_beams(Example& example, const Point& min, const Point& max, double y) {
    for (const double z : {min.z(), max.z() - 1}) {
        add(example, kBeamX, {min.x() + 1, y, z}, {max.x() - 1, y + 1, z + 1});
    }
    for (const double x : {min.x(), max.x() - 1}) {
        add(example, kBeamZ, {x, y, min.z() + 1}, {x + 1, y + 1, max.z() - 1});
    }
}

// A tower that steps back to a mast with a light.
void add_derrick(Example& example, const Point& at) {
    add(example, kDerrick, at, at + Point(3, 3, 3));
    add(example, kMast, at + Point(1, 3, 1), at + Point(2, 5, 2));
    add(example, kTip, at + Point(1, 5, 1), at + Point(2, 6, 2));
}

// A mast with a jib to each of two sides at right angles. A jib is an object of its own for each
// direction, so that it begins at a mast; else it could hang in the air.
void add_crane(Example& example, const Point& at, int quarters) {
    add(example, kMast, at, at + Point(1, 4, 1));
    add(example, kTip, at + Point(0, 4, 0), at + Point(1, 5, 1));
    for (const int turn : {quarters, quarters + 1}) {
        example.polyhedra.push_back(moved(
            turned(
                box(static_cast<ObjectId>(kJib + turn % 4), {0.5, 3, -0.5}, {4.5, 4, 0.5}), turn
            ),
            at + Point(0.5, 0, 0.5)
        ));
    }
}

}  // namespace

// Decks of one thickness on legs, with what stands on them (thesis, Figure 4.35).
Example make_oil_platform() {
    Example example;
    example.name = "oil_platform";
    example.title = "Oil platforms";
    example.description =
        "Decks on legs and beams in the sea, with cabins, cranes, derricks and landing pads.";
    example.materials = {
        {"sea", color(0x2F6F8F), 0, 0.35F},
        {"steel", color(0xE0A93B), 0, 0.7F},
        {"braces", color(0xC98F2B), 0, 0.7F},
        {"plating", color(0x7A8288), 0.1F, 0.7F},
        {"cabins", color(0xF0EEE8), 0, 0.6F},
        {"landing pad", color(0x3F8F6B), 0, 0.8F},
        {"derrick", color(0xC8412F), 0, 0.7F},
        {"crane", color(0xF2C230), 0, 0.6F},
        {"lights", color(0xFFF2C0), 0, 0.5F, color(0xFFD870)}};
    example.objects = {
        {"sea", kWater, 0},
        {"leg north-west", kSteel, 0.6},
        {"leg north-east", kSteel, 0.6},
        {"leg south-west", kSteel, 0.6},
        {"leg south-east", kSteel, 0.6},
        {"beam east-west", kBrace, 1},
        {"beam north-south", kBrace, 1},
        {"deck", kPlating, 8},
        {"cabin", kWhite, 2},
        {"bridge", kWhite, 1},
        {"landing pad", kGreen, 2},
        {"derrick", kRed, 2},
        {"light", kLight, 1},
        {"mast", kYellow, 0.5}};
    for (const char* direction : {"east", "north", "west", "south"}) {
        example.objects.push_back({std::string("jib ") + direction, kYellow, 1});
    }
    example.ground = kSea;

    add_deck(example, {0, 0, 0}, {12, 5, 12});
    add_beams(example, {0, 0, 0}, {12, 5, 12}, 2);
    add_derrick(example, {1, 5, 1});
    add(example, kCabin, {6, 5, 1}, {11, 6, 5});
    add(example, kBridge, {7, 6, 2}, {10, 7, 4});
    add_crane(example, {6, 5, 8}, 2);
    // A second one with an upper deck, and a bridge between the two.
    add_deck(example, {18, 0, 0}, {30, 5, 12});
    add_beams(example, {18, 0, 0}, {30, 5, 12}, 2);
    add_deck(example, {19, 5, 1}, {29, 9, 11});
    add_beams(example, {19, 5, 1}, {29, 9, 11}, 6);
    add(example, kPad, {20, 9, 6}, {24, 10, 10});
    add_crane(example, {26, 9, 3}, 0);
    add(example, kBeamX, {12, 4, 6}, {18, 5, 7});
    // A low one to the south.
    add_deck(example, {20, 0, 18}, {28, 5, 26});
    add(example, kBeamZ, {24, 4, 12}, {25, 5, 18});

    const Point x = Point::UnitX();
    const Point y = Point::UnitY();
    const Point z = Point::UnitZ();
    example.dimensions = {
        {kBeamX, y},
        {kBeamX, z},
        {kBeamZ, x},
        {kBeamZ, y},
        {kDeck, y},
        {kCabin, y},
        {kBridge, y},
        {kPad, y},
        {kMast, x},
        {kMast, z},
        {kTip, x},
        {kTip, y},
        {kTip, z}};
    for (int corner = 0; corner < 4; ++corner) {
        const auto leg = static_cast<ObjectId>(kLeg + corner);
        example.dimensions.push_back({leg, x});
        example.dimensions.push_back({leg, z});
    }
    for (int turn = 0; turn < 4; ++turn) {
        const auto jib = static_cast<ObjectId>(kJib + turn);
        example.dimensions.push_back({jib, y});
        example.dimensions.push_back({jib, turn % 2 == 0 ? z : x});
    }
    example.spacing = 1;
    example.density = 0.07;
    example.size = {40, 14, 40};
    return example;
}

}  // namespace modelsynth::examples
