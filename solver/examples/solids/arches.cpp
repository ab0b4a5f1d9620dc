#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;

// The ends of a chain and what is between them are different objects: so no pillar stands without
// its arches. Vaults of the two directions differ, since each is one spacing thick its own way.
enum : ObjectId { kGround = 1, kVaultX, kVaultZ, kWalk, kFirst, kLast, kInner };

constexpr double kTop = 4;   // of the vaults, above their foot
constexpr double kSpan = 3;  // of an opening
constexpr double kStride = kSpan + 1;

void add_pillar(Example& example, ObjectId object, const Point& foot) {
    example.polyhedra.push_back(box(object, foot, foot + Point(1, kTop, 1)));
}

// A vault over an opening that begins at `foot`.
void add_vault(Example& example, ObjectId object, const Point& foot) {
    const double at = object == kVaultX ? foot.x() : foot.z();
    const double y = foot.y() + kTop;
    const Outline outline = {
        {at, y - 2},
        {at + 1, y - 1},
        {at + kSpan - 1, y - 1},
        {at + kSpan, y - 2},
        {at + kSpan, y},
        {at, y}};
    example.polyhedra.push_back(
        object == kVaultX ? prism_along_z(object, outline, foot.z(), foot.z() + 1)
                          : prism_along_x(object, outline, foot.x(), foot.x() + 1)
    );
}

}  // namespace

// Pillars with vaults between them and a walk on top. A second tier stands on the first, and arches
// run both ways from one pillar: so arches pass over arches and stand in chains (thesis, Figure
// 4.31).
continuous::Example make_arches() {
    Example example;
    example.name = "arches";
    example.title = "Arches";
    example.description = "Chains of arches that cross and pass over each other.";
    example.materials = {
        {"ground", color(0xC9B184)},
        {"pillar", color(0xB5653F)},
        {"vault", color(0xD9895B)},
        {"walk", color(0xF0DDB8)}};
    example.objects = {
        {"ground", 0},
        {"vault x", 2},
        {"vault z", 2},
        {"walk", 3},
        {"first", 1, 0.6},
        {"last", 1, 0.6},
        {"inner", 1, 1.5}};
    example.ground = kGround;
    // A chain of so many arches along x, or along z; pillar `crossing` is that of both, which the
    // chain along x makes.
    const auto chain_x = [&](const Point& foot, int arches) {
        for (int i = 0; i <= arches; ++i) {
            const Point at = foot + Point(i * kStride, 0, 0);
            add_pillar(example, i == 0 ? kFirst : i == arches ? kLast : kInner, at);
            if (i < arches) {
                add_vault(example, kVaultX, at + Point::UnitX());
            }
        }
        const Point top = foot + Point(0, kTop, 0);
        example.polyhedra.push_back(box(kWalk, top, top + Point(arches * kStride + 1, 1, 1)));
    };
    const auto chain_z = [&](const Point& foot, int arches, int crossing) {
        for (int i = 0; i <= arches; ++i) {
            const Point at = foot + Point(0, 0, i * kStride);
            if (i != crossing) {
                add_pillar(example, i == 0 ? kFirst : i == arches ? kLast : kInner, at);
            }
            if (i < arches) {
                add_vault(example, kVaultZ, at + Point::UnitZ());
            }
        }
        const Point top = foot + Point(0, kTop, 0);
        example.polyhedra.push_back(box(kWalk, top, top + Point(1, 1, arches * kStride + 1)));
    };
    chain_x({0, 0, 8}, 3);
    chain_z({8, 0, 0}, 3, 2);
    // The second tier.
    chain_x({1, kTop + 1, 8}, 1);
    chain_z({8, kTop + 1, 1}, 1, -1);
    example.dimensions = {
        {kVaultX, Point::UnitZ()}, {kVaultZ, Point::UnitX()}, {kWalk, Point::UnitY()}};
    for (const ObjectId pillar : {kFirst, kLast, kInner}) {
        example.dimensions.push_back({pillar, Point::UnitX()});
        example.dimensions.push_back({pillar, Point::UnitZ()});
    }
    example.spacing = 1;
    example.size = {40, 12, 40};
    example.density = 0.2;
    return example;
}

}  // namespace modelsynth::examples
