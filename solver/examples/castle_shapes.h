#pragma once

#include "solver/examples/kit/mesh_builder.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

// What all pieces of the castle share: its palette, its measures and a few shapes of masonry.
namespace modelsynth::examples::castle {

struct Palette {
    MaterialId stone = 0;  // sandstone of walls
    MaterialId trim = 0;   // deeper sandstone of plinths, frames and corbels
    MaterialId slate = 0;  // blue roofs and shutters, the cool accent
    MaterialId grass = 0;
    MaterialId paving = 0;
    MaterialId dark = 0;  // openings and iron
    MaterialId wood = 0;
    MaterialId flag = 0;
    MaterialId leaf = 0;
    MaterialId gold = 0;
    MaterialId earth = 0;    // the courts' trodden ground
    MaterialId plaster = 0;  // walls of cottages
    MaterialId tile = 0;     // their roofs, the warm accent
    MaterialId wheat = 0;
};

// Half the thickness of a curtain wall, and how far its parapet stands out.
inline constexpr float kWallHalf = 0.6F;
inline constexpr float kParapetOut = 0.74F;
inline constexpr float kParapetIn = 0.52F;
// Towers fill their cells, with corners cut so little that the parapet of a wall still ends on
// their flat side.
inline constexpr float kTowerCut = 0.25F;
// Plain masonry is drawn below full brightness, so that single blocks can be lighter than it.
inline constexpr float kStoneTint = 0.96F;
// Ground beside walls and buildings, and how dark masonry is at its foot.
inline constexpr float kShadyTint = 0.92F;
inline constexpr float kFootShade = 0.86F;

// How an outline (x, z), counter-clockwise from above, lies when it is drawn `out` metres from
// the middle of its cell.
using Outline = std::function<std::vector<Point2>(float out)>;

// The surface over a profile (out, y), from its outer or lower end inwards or upwards.
void loft(MeshBuilder& mesh, std::span<const Point2> profile, const Outline& outline);

// A square with cut corners, closed.
[[nodiscard]] Outline cut_square(float cut);

// The flat cap inside a closed, convex outline.
void cap(MeshBuilder& mesh, const Outline& outline, float out, float y);

// A rectangle of a plane: x0 ... x1 by y0 ... y1.
struct Panel {
    float x0 = 0;
    float x1 = 0;
    float y0 = 0;
    float y1 = 0;
};

// Single blocks that stand out a little from a wall that faces south at depth z. `share` of them
// are there.
void add_blocks(
    MeshBuilder& mesh,
    const Palette& palette,
    std::uint32_t seed,
    const Panel& panel,
    float z,
    float share
);

// A window with pointed head in a wall that faces south at depth z, frame and sill standing out.
void add_window(MeshBuilder& mesh, const Palette& palette, const Panel& panel, float z);

// Corbels under a parapet that faces south, at x = -0.75, -0.25, ... within x0 ... x1.
void add_corbels(MeshBuilder& mesh, const Palette& palette, float x0, float x1, float z, float y);

// A surface of roof over the outline, from (out0, y0) to (out1, y1), in courses that overlap.
void add_courses(
    MeshBuilder& mesh, const Outline& outline, const Point2& from, const Point2& to, int courses
);

// A staff with a pennant that streams east, its foot at (x, y, z).
void add_flag(MeshBuilder& mesh, const Palette& palette, const Vec3& foot, float height);

// The cell's ground, where it is plain grass.
void add_grass(MeshBuilder& mesh, const Palette& palette);

// The cell's ground inside the walls.
void add_earth(MeshBuilder& mesh, const Palette& palette);

// Flat cobbles over the rectangle, in rows and columns of uneven stones.
void add_cobbles(
    MeshBuilder& mesh,
    const Palette& palette,
    std::uint32_t seed,
    const Extent& extent,
    int columns,
    int rows
);

}  // namespace modelsynth::examples::castle
