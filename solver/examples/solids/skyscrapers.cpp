#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

// A tower with a lower wing: one concave edge is enough for setbacks (thesis, Figure 4.28).
continuous::Example make_skyscrapers() {
    enum : continuous::ObjectId { kStreet = 1, kTower };

    continuous::Example example;
    example.name = "skyscrapers";
    example.title = "Skyscrapers";
    example.description = "Towers with wings and setbacks.";
    example.materials = {{"street", color(0x5A5D60)}, {"tower", color(0xB9C2C9)}};
    example.objects = {{"street", 0}, {"tower", 1}};
    example.ground = kStreet;
    example.polyhedra = {box(kTower, {0, 0, 0}, {4, 3, 2}), box(kTower, {0, 0, 2}, {2, 2, 4})};
    example.spacing = 1;
    example.size = {40, 12, 40};
    return example;
}

}  // namespace modelsynth::examples
