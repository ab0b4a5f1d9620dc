#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

namespace modelsynth::examples {

// Two wings at right angles, one with its gable in the other's roof: from these come T-shaped,
// L-shaped and crossing houses of any size (thesis, Figure 4.32).
continuous::Example make_houses() {
    enum : continuous::ObjectId { kGrass = 1, kWall, kRoof };

    continuous::Example example;
    example.name = "houses";
    example.title = "Houses";
    example.description = "Gabled wings that meet at right angles; roofs join as roofs do.";
    example.materials = {
        {"grass", color(0x7D9A4E)}, {"plaster", color(0xEADFC8)}, {"tiles", color(0xA6492F)}};
    example.objects = {{"grass", 0}, {"wall", 1}, {"roof", 2}};
    example.ground = kGrass;
    example.polyhedra = {
        box(kWall, {0, 0, 0}, {2, 1, 6}),
        prism_along_z(kRoof, {{0, 1}, {2, 1}, {1, 2}}, 0, 6),
        box(kWall, {2, 0, 2}, {6, 1, 4}),
        prism_along_x(kRoof, {{2, 1}, {4, 1}, {3, 2}}, 2, 6)};
    example.spacing = 1;
    example.size = {32, 10, 32};
    return example;
}

}  // namespace modelsynth::examples
