#pragma once

#include "solver/examples/canyon_palette.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace modelsynth::examples {

// How the line that parts rock from air runs through a cell. As built:
enum class CliffShape : std::uint8_t {
    kEdge,     // rock in the west, air in the east
    kConvex,   // rock only at the south-west corner of the cell
    kConcave,  // air only at the north-east corner
};
inline constexpr int kCliffShapeCount = 3;

enum class CliffKind : std::uint8_t {
    kValleyFoot,   // rises from the valley floor
    kMiddle,       // between a foot and a rim
    kRim,          // the cap rock and the ground on top of it
    kTerraceFoot,  // rises from the top of a lower mesa
};
inline constexpr int kCliffKindCount = 4;

// Lines through a cell from wall to wall that keep a given distance from the middle line of a
// cliff; positive distances lie on the air side. On the cell walls the lines of all shapes meet.
class Contour {
  public:
    explicit Contour(CliffShape shape) : shape_(shape) {}

    static constexpr int kSegments = 8;

    // The `index`-th point (0 ... kSegments) of the line at `distance`, as (x, z).
    [[nodiscard]] Point2 at(int index, float distance) const;
    // Where the point's ray leaves the cell on the air side and on the rock side.
    [[nodiscard]] Point2 outer(int index) const;
    [[nodiscard]] Point2 inner(int index) const;

  private:
    CliffShape shape_;
};

// A stop of a cross-section, from the outside in: `material` is of what lies between it and the
// next. Stops of one `seed` have the same cracks, so that what stacks meets; seed 0 has none.
struct SectionStop {
    float distance;
    float y;
    MaterialId material;
    std::uint32_t seed = 0;
};

// Draws a cross-section along a line of `segments` parts, left to right seen from the air. The line
// gives the place, as (x, z), of a point by its index and its distance.
void sweep_section(
    MeshBuilder& mesh,
    const std::function<Point2(int index, float distance)>& line,
    int segments,
    const std::vector<SectionStop>& section
);
void sweep_section(
    MeshBuilder& mesh, const Contour& contour, const std::vector<SectionStop>& section
);
// The flat ground between a stop of a section and the cell walls, on the air side or on the rock
// side.
void ground_outside(MeshBuilder& mesh, const Contour& contour, const SectionStop& stop);
void ground_inside(MeshBuilder& mesh, const Contour& contour, const SectionStop& stop);

// The cross-section of a kind of cliff.
[[nodiscard]] std::vector<SectionStop> cliff_section(const CanyonPalette& palette, CliffKind kind);
// Darker near the ground and where rock overhangs; before ground is added.
void shade_cliff(MeshBuilder& mesh, CliffKind kind);

[[nodiscard]] MeshBuilder make_cliff(
    const CanyonPalette& palette, CliffKind kind, CliffShape shape
);

}  // namespace modelsynth::examples
