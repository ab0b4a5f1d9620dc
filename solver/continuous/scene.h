#pragma once

#include "solver/continuous/reading.h"
#include "solver/continuous/surface.h"
#include "solver/mesh/scene.h"

namespace modelsynth::continuous {

// A surface to look at: one mesh with a part for each material, flat faces, texture coordinates in
// metres along each face, upright where the face is. Frame: that of the model.
[[nodiscard]] Scene make_scene(const ExampleReading& reading, const Surface& surface);

// The part of it inside a box, cut open where it goes on.
[[nodiscard]] Scene make_scene(
    const ExampleReading& reading, const Surface& surface, const Bounds& part
);

// The example's solids as they were given, overlaps too, without its ground.
[[nodiscard]] Scene make_example_scene(const ExampleReading& reading);

}  // namespace modelsynth::continuous
