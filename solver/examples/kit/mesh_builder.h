#pragma once

#include "solver/mesh/mesh.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::examples {

// Handle of a material of the kit that is being built.
using MaterialId = std::uint32_t;

// A colour as artists write it: 0xRRGGBB in sRGB, returned linear.
[[nodiscard]] Color srgb(std::uint32_t hex);

// Two corners of an axis-aligned box, metres.
struct Extent {
    Vec3 min;
    Vec3 max;
};

// A point of an outline; what the two axes are is said by each function.
struct Point2 {
    float u = 0;
    float v = 0;
};

// Builds one mesh out of the small vocabulary below. Frame: that of a piece, the origin in the
// middle of the cell's floor, y up, metres. Normals are flat unless said otherwise. Every shape
// takes its colour from the material and a tint that multiplies it (1 = as it is).
//
// After the shapes, shade() darkens vertex colours by place; call it once, last.
class MeshBuilder {
  public:
    MeshBuilder& material(MaterialId material);  // of all shapes that follow
    MeshBuilder& tint(float brightness);         // of all shapes that follow
    MeshBuilder& tint(float red, float green, float blue);

    // --- solids
    MeshBuilder& box(const Extent& extent);
    // A box whose upper edges and upright edges are cut by `bevel` metres.
    MeshBuilder& bevelled_box(const Extent& extent, float bevel = 0.03F);
    // A box without some of its faces, for faces that lie on a cell wall or are never seen.
    // `faces` has a letter per face wanted: E W U D S N.
    MeshBuilder& open_box(const Extent& extent, const char* faces);
    // An outline in (x, z), counter-clockwise seen from above, raised from y0 to y1. `caps`: with
    // top and bottom. Convex outlines only for the caps.
    MeshBuilder& prism(std::span<const Point2> outline, float y0, float y1, bool caps = true);
    // An outline in (x, y), counter-clockwise seen from the south (+z), drawn out from z0 to z1.
    MeshBuilder& extrude(std::span<const Point2> outline, float z0, float z1, bool caps = true);
    // An outline (radius, y) from below to above, turned about the vertical axis at (x, z).
    MeshBuilder& lathe(
        float x, float z, std::span<const Point2> profile, int segments, bool smooth = true
    );
    MeshBuilder& cylinder(float x, float z, float radius, float y0, float y1, int segments = 10);
    MeshBuilder& cone(float x, float z, float radius, float y0, float y1, int segments = 10);
    // A low-poly ball, smooth, squashed to the radii.
    MeshBuilder& ball(const Vec3& centre, const Vec3& radii, int segments = 8);
    // A roof with two slopes whose ridge runs along x, eaves at y0, ridge at y1, gables closed.
    // `overhang` metres beyond the extent's north and south; `thickness` of the slopes.
    MeshBuilder& gable_roof(const Extent& extent, float overhang, float thickness);
    // A roof with four slopes that meet in the middle (a pyramid when square).
    MeshBuilder& hip_roof(const Extent& extent, float overhang);
    // Steps rising towards north (-z) within the extent.
    MeshBuilder& stairs(const Extent& extent, int steps);
    // A wall of the extent, drawn out along z, with an arched opening of the given width and
    // springing height in its middle, seen from north and south; opening is closed at the top by
    // a half circle of `segments` parts. The wall's extent must be higher than the arch.
    MeshBuilder& arch(const Extent& extent, float width, float springing_y, int segments = 8);
    // A triangle or a flat quad, counter-clockwise seen from its front.
    MeshBuilder& triangle(const Vec3& a, const Vec3& b, const Vec3& c);
    MeshBuilder& quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

    // --- composition
    // What `make` adds is turned by quarter turns about the origin (one turn: east to north).
    MeshBuilder& turned(int quarter_turns, const std::function<void(MeshBuilder&)>& make);
    // ... turned by an angle about the vertical axis, scaled and moved.
    MeshBuilder& placed(
        const Vec3& offset,
        float angle_radians,
        float scale,
        const std::function<void(MeshBuilder&)>& make
    );
    // ... mirrored: x becomes -x.
    MeshBuilder& mirrored(const std::function<void(MeshBuilder&)>& make);

    // --- shade
    // Multiplies the colours of all vertices so far with what `brightness` says of the place.
    MeshBuilder& shade(
        const std::function<float(const Vec3& position, const Vec3& normal)>& brightness
    );
    // The usual one: `dark` at y = 0 rising to 1 at y = height, faces that look down darker still.
    MeshBuilder& shade_upwards(float dark, float height);

    [[nodiscard]] Mesh build(std::string name) &&;
    [[nodiscard]] std::size_t triangle_count() const;

  private:
    struct Vertex {
        Vec3 position;
        Vec3 normal;
        std::array<float, 3> color;
    };

    struct Triangle {
        std::array<Vertex, 3> corners;
        MaterialId material;
    };

    void add(const Vec3& a, const Vec3& b, const Vec3& c);
    void add_smooth(const std::array<Vec3, 3>& positions, const std::array<Vec3, 3>& normals);
    MeshBuilder& transformed(
        const std::function<Vec3(const Vec3&)>& place,
        const std::function<Vec3(const Vec3&)>& turn,
        bool flips,
        const std::function<void(MeshBuilder&)>& make
    );

    std::vector<Triangle> triangles_;
    MaterialId material_ = 0;
    std::array<float, 3> tint_ = {1, 1, 1};
};

// A small repeatable random number in 0 ... 1, for scatter: the same for the same arguments.
[[nodiscard]] float scatter(std::uint32_t seed, std::uint32_t index);

}  // namespace modelsynth::examples
