#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "solver/examples/solids/turned.h"

#include <string>

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

// Pipes by the axis along which they run, and joints by the plane in which they lie. There are no
// loose ends because what is seen at a joint's corners does not allow any: every corner of a tee
// has a pipe on one of its two sides at least; of two opposite elbows with one id between them,
// two corners have exactly one pipe and the two others both or none. All four elbows together would
// allow a lone pipe.
enum : ObjectId {
    kFloor = 1,
    kTank,
    kValve,
    kPipe,
    kElbow = kPipe + 3,
    kTee = kElbow + 6,
    kEnd = kTee + 3
};

enum : std::uint32_t { kConcrete, kPaint, kCopper, kBrass, kIron, kRed };

ObjectId joint(int kind, int number) { return static_cast<ObjectId>(kind + number); }

void place(
    Example& example,
    ObjectId object,
    const Point& min,
    const Point& max,
    int plane,
    const Point& at
) {
    example.polyhedra.push_back(moved(rolled(box(object, min, max), plane), at));
}

// A ring with a cross in it has every joint of its plane in every turn. Plane 0 is level; each
// further one is that before it, rolled on.
void add_window(Example& example, int plane, const Point& at) {
    constexpr double kArm = 4;
    constexpr int kAlongZ = 2;
    const auto add = [&](ObjectId object, const Point& min, const Point& max) {
        place(example, object, min, max, plane, at);
    };
    for (int row = 0; row < 3; ++row) {
        for (int i = 0; i < 2; ++i) {
            const double begin = i * kArm + 1;
            const double end = begin + kArm - 1;
            const double side = row * kArm;
            add(joint(kPipe, plane), {begin, 0, side}, {end, 1, side + 1});
            add(joint(kPipe, (plane + kAlongZ) % 3), {side, 0, begin}, {side + 1, 1, end});
        }
    }
    const auto add_joint = [&](int kind, int number, const Point& where) {
        const Point min = kArm * (Point(1, 0, 1) + where);
        add(joint(kind, number), min, min + Point::Ones());
    };
    for (int turn = 0; turn < 4; ++turn) {
        add_joint(kElbow, 2 * plane + turn % 2, turned(Point(1, 0, 1), turn));
        add_joint(kTee, plane, turned(Point(1, 0, 0), turn));
    }
    add_joint(kTee, plane, Point::Zero());
    add(kValve, {2, 0, 0}, {3, 1, 1});
}

// Four tanks on the floor, joined by pipes; one goes up from each, out of the example.
void add_tanks(Example& example, const Point& at) {
    const auto add_pipe = [&](int axis, const Point& min, const Point& max) {
        example.polyhedra.push_back(moved(box(joint(kPipe, axis), min, max), at));
    };
    for (const double x : {0.0, 6.0}) {
        add_pipe(2, {x + 1, 1, 3}, {x + 2, 2, 6});
        add_pipe(0, {3, 1, x + 1}, {6, 2, x + 2});
        for (const double z : {0.0, 6.0}) {
            const Outline plan = {{0, -3}, {3, -3}, {3, 0}, {0, 0}};
            example.polyhedra.push_back(moved(prism_upwards(kTank, plan, 0, 3), at + Point(x, 0, z))
            );
            add_pipe(1, {x + 1, 3, z + 1}, {x + 2, 20, z + 2});
        }
    }
}

}  // namespace

// Square pipes that go everywhere and end nowhere but in a tank or the floor (thesis, Figure 4.39).
Example make_plumbing() {
    Example example;
    example.name = "plumbing";
    example.title = "Plumbing";
    example.description =
        "Pipes of one thickness with elbows, tees, crosses and valves, between tanks and the "
        "floor.";
    example.materials = {
        {"concrete", color(0x8D8F8C), 0, 0.95F},
        {"cream paint", color(0xE4DCC4), 0, 0.6F},
        {"copper", color(0xD9915F), 0.1F, 0.5F},
        {"brass", color(0xE3C06A), 0.1F, 0.5F},
        {"iron", color(0x66727E), 0.1F, 0.6F},
        {"red paint", color(0xC7372F), 0, 0.5F}};
    example.objects = {{"floor", kConcrete, 0}, {"tank", kPaint, 3}, {"valve", kRed, 1}};
    const auto add_objects =
        [&](const std::string& kind, int count, std::uint32_t material, double weight) {
            for (int i = 1; i <= count; ++i) {
                example.objects.push_back({kind + " " + std::to_string(i), material, weight});
            }
        };
    add_objects("pipe", 3, kCopper, 3);
    add_objects("elbow", 6, kBrass, 1);
    add_objects("tee", 3, kIron, 1);
    example.ground = kFloor;

    add_window(example, 0, {0, 2, 0});
    add_window(example, 1, {0, 2, 14});
    add_window(example, 2, {14, 2, 0});
    add_tanks(example, {14, 0, 14});
    example.polyhedra.push_back(box(joint(kPipe, 1), {4, 0, 25}, {5, 20, 26}));
    example.bounds = {Point(-1, -1, -1), Point(28, 15, 28)};

    for (int object = kValve; object < kEnd; ++object) {
        for (int axis = 0; axis < 3; ++axis) {
            if (object != kPipe + axis) {
                example.dimensions.push_back({static_cast<ObjectId>(object), Point::Unit(axis)});
            }
        }
    }
    std::vector<ObjectId>& network = example.connected.emplace_back();
    for (int object = kTank; object < kEnd; ++object) {
        network.push_back(static_cast<ObjectId>(object));
    }
    example.spacing = 1;
    example.density = 0.03;
    example.size = {30, 14, 30};
    return example;
}

}  // namespace modelsynth::examples
