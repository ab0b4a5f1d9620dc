#pragma once

#include "solver/examples/canyon_palette.h"

#include <cstdint>
#include <vector>

namespace modelsynth::examples {

// --- single bodies, for pieces to be put together of

// A level of an upright body: an uneven ring of rock, and the material from it up to the next.
struct RockRing {
    float radius;
    float y;
    MaterialId material;
    std::uint32_t seed;
};

// Rock, or foliage, built of rings from below to above about the vertical axis at (x, z), closed
// at the top.
void add_rock(
    MeshBuilder& mesh, float x, float z, const std::vector<RockRing>& rings, int sides = 7
);
// A boulder or a bush: a squat body that stands on y.
void add_lump(
    MeshBuilder& mesh,
    const Vec3& foot,
    float radius,
    float height,
    MaterialId material,
    std::uint32_t seed
);
// Blades that spread from a spot.
void add_tuft(
    MeshBuilder& mesh, const Vec3& foot, float size, MaterialId material, std::uint32_t seed
);
// The ground of a cell, uneven but level at the cell walls.
void add_ground(MeshBuilder& mesh, MaterialId material, std::uint32_t seed);

// --- pieces that stand on plain ground

[[nodiscard]] MeshBuilder make_valley(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_pebbles(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_saguaro(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_sage(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_boulders(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_turf(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_tufts(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_slabs(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_juniper(const CanyonPalette& palette);
// Door to the east.
[[nodiscard]] MeshBuilder make_house(const CanyonPalette& palette);

}  // namespace modelsynth::examples
