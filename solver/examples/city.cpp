#include "solver/examples/built_in.h"
#include "solver/examples/example_builder.h"

namespace modelsynth::examples {

discrete::Example make_city() {
    ExampleBuilder builder("city", 2, 2, 2);
    const MaterialId stone = builder.add_material({"stone", srgb(0xC8B08A)});
    builder.add_empty(' ', "air");
    builder.add_piece(
        '.', "ground", MeshBuilder().material(stone).open_box({{-1, 0, -1}, {1, 0.2F, 1}}, "U")
    );
    builder.add_piece(
        '#',
        "pillar",
        MeshBuilder().material(stone).bevelled_box({{-0.6F, 0, -0.6F}, {0.6F, 2, 0.6F}}
        ).shade_upwards(0.6F, 2)
    );
    builder.add_floor({".....", ".#.#.", ".....", ".....", "....."});
    builder.add_floor({"     ", " #   ", "     ", "     ", "     "});
    builder.add_floor({"     ", "     ", "     ", "     ", "     "});
    builder.set_boundary(
        {{{},
          {},
          {discrete::BoundaryKind::kPieces, {"air"}},
          {discrete::BoundaryKind::kExample, {}},
          {},
          {}}}
    );
    return std::move(builder).build();
}

}  // namespace modelsynth::examples
