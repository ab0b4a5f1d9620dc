#pragma once

#include "solver/continuous/reading/reading.h"
#include "solver/continuous/surface/surface.h"
#include "solver/mesh/scene.h"

namespace modelsynth::continuous {

// A surface to look at, with the shapes and decorations of its objects: one mesh with a part for
// each material, flat faces but for shapes. Frame: that of the model.
// Every vertex has texture coordinates in metres, or in repeats of its material's texture: u along
// the horizontal of its face, to the right seen from outside, and v down the face; of horizontal
// faces u is east (x) and from above v is south (z). They are counted from the model's origin, so
// that what lies in one plane and looks the same way has one picture, across polygons and blocks.
[[nodiscard]] Scene make_scene(const ExampleReading& reading, const Surface& surface);

// The part of it inside a box, cut open where it goes on. Decorations are not cut: each is in the
// part in which the middle of its edge, or its corner, lies, that is in one of parts side by side.
[[nodiscard]] Scene make_scene(
    const ExampleReading& reading, const Surface& surface, const Bounds& part
);

// The example's solids as they were given, overlaps too, without its ground.
[[nodiscard]] Scene make_example_scene(const ExampleReading& reading);

}  // namespace modelsynth::continuous
