#pragma once

#include "solver/continuous/problem.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A flat part of the border of one object type, as large as it goes.
struct SurfacePolygon {
    ObjectId object = 0;
    std::uint8_t family = 0;      // kNoFamily: it lies in a side of the model's box, which cut it
    bool is_along_normal = true;  // the family's normal points out of the object; else into it
    // Numbers of points; the outer one is counter-clockwise seen from outside, the others, which
    // are holes, clockwise. A loop may come to a point several times.
    std::vector<std::vector<std::uint32_t>> loops;
};

// The border of every object of a model. Of each object it is closed: every edge of a polygon is
// that of another one, the other way round, between the same two points.
struct Surface {
    std::vector<Point> points;  // metres
    std::vector<SurfacePolygon> polygons;
    // False where borders at a free side enclosed nothing together, as may be where lines only cut
    // off a corner of the planes' box: what was to be there is left out.
    bool is_closed = true;
};

// Read from the figures alone: where the figure of an edge has an object on one side of it in a
// plane and not on the other, a border runs along it. A vertex is a corner of all polygons of an
// object that meet there or of none, so that no corner lies within another polygon's side.
// What goes on beyond the model's box, as the ground does, ends in its sides.
// Perturbed where the problem asks for it.
// Shape: a label per vertex; the labels are consistent. Deterministic. Cost: O(vertices).
[[nodiscard]] Surface make_surface(const Problem& problem, std::span<const Label> labels);

}  // namespace modelsynth::continuous
