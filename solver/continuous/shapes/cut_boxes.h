#pragma once

#include "solver/continuous/example.h"
#include "solver/core/result.h"

#include <vector>

namespace modelsynth::continuous {

// What keeps shapes from being put in the place of solids: a shape that is flat, that grows evenly
// along one axis alone, or whose object's solids are no boxes along the axes or touch each other.
// Pointers are relative to the example. Cost: O(solids^2) of such objects.
[[nodiscard]] std::vector<Fault> find_shape_faults(const Example& example);

// Cuts the boxes of shapes that grow evenly in two: what has no parallel faces across a direction
// cannot be stretched along it alone (thesis 4.6.4, Figure 4.27). Along two axes they are cut along
// the diagonal into prisms, along three a corner tetrahedron is cut off. The rest becomes an object
// of its own that has the first one's material, weight and dimensions, and hangs together with it.
// Requires: find_shape_faults() finds nothing.
void cut_boxes(Example& example);

// The example before its boxes were cut.
[[nodiscard]] Example with_whole_boxes(Example example);

// What share of its box an object's solid is: 1, or less of what is cut.
[[nodiscard]] double share_of_box(const Example& example, ObjectId object);

}  // namespace modelsynth::continuous
