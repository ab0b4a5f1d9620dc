#pragma once

#include "solver/examples/castle_shapes.h"

#include <array>

// Walls, a piece each from the ground to the battlements: what stands above one is air.
namespace modelsynth::examples::castle {

// To which sides a wall leads on: east, north, west, south.
using Arms = std::array<bool, 4>;

// Which part of the cell is meadow, as built.
enum class CurtainShape : std::uint8_t {
    kStraight,  // the east
    kConvex,    // the east and the north
    kConcave,   // the corner between them
};

// A wall between court and meadow.
[[nodiscard]] MeshBuilder make_curtain(const Palette& palette, CurtainShape shape);
// A gate in one, out to the east.
[[nodiscard]] MeshBuilder make_gate(const Palette& palette);
// A wall along x from court to court.
[[nodiscard]] MeshBuilder make_inner_wall(const Palette& palette);
[[nodiscard]] MeshBuilder make_inner_gate(const Palette& palette);

}  // namespace modelsynth::examples::castle
