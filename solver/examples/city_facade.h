#pragma once

#include "solver/examples/city_materials.h"
#include "solver/examples/kit/mesh_builder.h"

#include <cstdint>
#include <functional>
#include <span>

namespace modelsynth::examples {

// Parts of a facade. All are built facing south on the south wall of the cell (z = +2), with u = x
// from left to right and v = y; MeshBuilder::turned takes them to the other sides.

struct Opening {
    float u0 = 0;
    float u1 = 0;
    float v0 = 0;
    float v1 = 0;
    bool is_lit = false;
};

// How a run of trim ends on the right: at the cell wall, where the next cell goes on, or round the
// convex corner of a building. A corner is closed by the facade that has it on its right.
enum class RightEnd : std::uint8_t { kGoesOn, kCorner };

// A wall from u0 to u1 and v0 to v1 with openings (from left to right, apart), their reveals
// `depth` deep and panes at the back, lit or dark. Material and tint are those set for the wall.
void add_wall(
    MeshBuilder& mesh,
    const CityMaterials& materials,
    MaterialId wall,
    const Opening& whole,
    std::span<const Opening> openings,
    float depth
);

// A band along the whole facade that stands out by `reach`.
void add_band(MeshBuilder& mesh, float v0, float v1, float reach, RightEnd end);

// A box on the facade, open at its back.
void add_block(MeshBuilder& mesh, float u0, float u1, float v0, float v1, float reach);

// Bars of a window in its opening: `columns` by `rows` panes, and a sill.
void add_window_bars(
    MeshBuilder& mesh,
    const CityMaterials& materials,
    const Opening& opening,
    float depth,
    int columns,
    int rows
);

// A facade on the east side, or on the east and north sides with the corner between them.
MeshBuilder make_side(const std::function<void(MeshBuilder&, RightEnd)>& facade);
MeshBuilder make_corner(
    const std::function<void(MeshBuilder&, RightEnd)>& east,
    const std::function<void(MeshBuilder&, RightEnd)>& north
);

}  // namespace modelsynth::examples
