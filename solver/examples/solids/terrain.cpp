#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

// Islands: beaches of sand, rock that rises in slopes and cliffs, turf on its terraces (thesis,
// Figure 4.30). All slopes are at 45 degrees.
continuous::Example make_terrain() {
    enum : continuous::ObjectId { kWater = 1, kSand, kRock, kTurf };

    continuous::Example example;
    example.name = "terrain";
    example.title = "Rocky terrain";
    example.description = "Islands with beaches, cliffs and green terraces.";
    example.materials = {
        {"water", color(0x3E86A0), 0.1F, 0.3F},
        {"sand", color(0xE3CF9B)},
        {"rock", color(0x8C8279)},
        {"turf", color(0x7C9C4B)}};
    example.objects = {{"water", 0}, {"sand", 1}, {"rock", 2}, {"turf", 3}};
    example.ground = kWater;
    example.polyhedra = {
        tapered(kSand, {0, 0, 0}, {20, 1, 18}, {1, 1, 1, 1}),
        tapered(kSand, {8, 0, 8}, {28, 1, 26}, {1, 1, 1, 1}),
        // A hill, ...
        tapered(kRock, {2, 1, 2}, {14, 4, 12}, {3, 3, 3, 3}),
        tapered(kTurf, {5, 4, 5}, {11, 5, 9}, {1, 1, 1, 1}),
        // ... and one with cliffs to two sides, and an outcrop.
        tapered(kRock, {12, 1, 10}, {24, 3, 22}, {2, 0, 2, 0}),
        tapered(kTurf, {14, 3, 12}, {24, 4, 22}, {1, 0, 1, 0}),
        tapered(kRock, {16, 4, 14}, {21, 6, 19}, {0, 2, 0, 2}),
    };
    example.dimensions = {{kSand, {0, 1, 0}}, {kTurf, {0, 1, 0}}};
    example.spacing = 1;
    example.size = {40, 10, 40};
    example.density = 0.6;
    return example;
}

}  // namespace modelsynth::examples
