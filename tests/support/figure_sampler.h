#pragma once

#include "tests/support/cone_cells.h"
#include "tests/support/polygon_set.h"

#include <string>
#include <vector>

namespace modelsynth::testing {

// Where something changes in a set of solids: corners, points where a border's edge meets another
// edge or face, points between any two that follow each other on an edge, and points of all faces
// beside these. Only what is strictly inside the clip.
// `may_overlap`: borders may go through each other and through the clip's sides; the lines along
// which they do so are edges, too.
[[nodiscard]] std::vector<Point> find_special_points(const PolygonSet& set, bool may_overlap);

// The objects around a point, one for each cell.
struct SampledFigure {
    std::string objects;
    bool is_overlap = false;     // two solids are in one place
    bool is_inside_out = false;  // a winding number is neither 0 nor 1
    bool is_unclear = false;     // something comes nearer than can be told apart
    bool is_foreign = false;     // a face through the point has a normal that the cells do not know
};

// Of solids in one place the last one counts.
[[nodiscard]] SampledFigure sample_figure(
    const PolygonSet& set, const ConeCells& cells, const Point& point
);

}  // namespace modelsynth::testing
