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
    kMeadow = 1,
    kTrackX,
    kTrackZ,
    kBend,
    kClimb = kBend + 4,
    kPost = kClimb + 4,
    kCar
};

enum : std::uint32_t { kGrass, kRed, kOrange, kYellow, kWhite, kBlue };

void add(Example& example, ObjectId object, const Point& min, const Point& max) {
    example.polyhedra.push_back(box(object, min, max));
}

// A ring with a hill on each side; the corners alternate between low and high, so that there are
// climbs in both directions of both axes. `low` and `high` are the undersides of the track.
void add_circuit(Example& example, const Point& at, double low, double high) {
    constexpr double kSide = 14;
    const double rise = high - low;
    std::size_t first = example.polyhedra.size();
    for (int turn = 0; turn < 4; ++turn) {
        const std::size_t begin = example.polyhedra.size();
        // The south side, from the south-west corner to the south-east one, middle at the origin.
        const double z = kSide / 2;
        const double half = kSide / 2;
        const bool is_along_x = turn % 2 == 0;
        const ObjectId track = is_along_x ? kTrackX : kTrackZ;
        const double from = is_along_x ? low : high;
        const double foot = -rise / 2;
        const double top = rise / 2;
        const double y0 = from;
        const double y1 = is_along_x ? high : low;
        add(example, track, {-half + 1, y0, z - 1}, {foot, y0 + 1, z});
        add(example, track, {top, y1, z - 1}, {half - 1, y1 + 1, z});
        const Outline slope = {{foot, y0}, {top, y1}, {top, y1 + 1}, {foot, y0 + 1}};
        example.polyhedra.push_back(
            prism_along_z(static_cast<ObjectId>(kClimb + turn), slope, z - 1, z)
        );
        add(example, static_cast<ObjectId>(kBend + turn), {half - 1, y1, z - 1}, {half, y1 + 1, z});
        add(example, kPost, {half - 1, 0, z - 1}, {half, y1, z});
        add(example, kPost, {top + 1, 0, z - 1}, {top + 2, y1, z});
        add(example, kPost, {foot - 2, 0, z - 1}, {foot - 1, y0, z});
        for (std::size_t i = begin; i < example.polyhedra.size(); ++i) {
            example.polyhedra[i] = turned(example.polyhedra[i], turn);
        }
    }
    for (; first < example.polyhedra.size(); ++first) {
        example.polyhedra[first] = moved(example.polyhedra[first], at);
    }
}

}  // namespace

// Tracks of one width that climb, fall and turn and never end (thesis, Figure 4.40).
Example make_roller_coaster() {
    Example example;
    example.name = "roller_coaster";
    example.title = "Roller coaster";
    example.description =
        "Tracks of one width that climb and fall at 45 degrees and turn, on posts, without an end.";
    example.materials = {
        {"grass", color(0x8DB255), 0, 0.95F},
        {"red rails", color(0xD8402F), 0, 0.6F},
        {"orange rails", color(0xF08A24), 0, 0.6F},
        {"yellow rails", color(0xF5C02E), 0, 0.6F},
        {"white posts", color(0xF1EFE6), 0, 0.8F}};
    example.objects = {{"meadow", kGrass, 0}, {"track 1", kRed, 3}, {"track 2", kRed, 3}};
    for (int turn = 1; turn <= 4; ++turn) {
        example.objects.push_back({"bend " + std::to_string(turn), kOrange, 0.7});
    }
    for (int turn = 1; turn <= 4; ++turn) {
        example.objects.push_back({"climb " + std::to_string(turn), kYellow, 2});
    }
    example.objects.push_back({"post", kWhite, 1});
    example.ground = kMeadow;

    add_circuit(example, {0, 0, 0}, 2, 6);

    const auto fix = [&](int object, const Point& normal) {
        example.dimensions.push_back({static_cast<ObjectId>(object), normal});
    };
    const Point x = Point::UnitX();
    const Point y = Point::UnitY();
    const Point z = Point::UnitZ();
    for (int turn = 0; turn < 4; ++turn) {
        fix(kBend + turn, x);
        fix(kBend + turn, y);
        fix(kBend + turn, z);
        fix(kClimb + turn, turn % 2 == 0 ? z : x);
        fix(kClimb + turn, turned(Point(turn % 2 == 0 ? -1 : 1, 1, 0), turn));
    }
    fix(kTrackX, y);
    fix(kTrackX, z);
    fix(kTrackZ, x);
    fix(kTrackZ, y);
    fix(kPost, x);
    fix(kPost, z);
    example.spacing = 1;
    example.density = 0.06;
    example.size = {40, 12, 40};
    return example;
}

}  // namespace modelsynth::examples
