#pragma once

#include "solver/continuous/import/imported_example.h"
#include "solver/core/result.h"

#include <cstddef>
#include <span>

namespace modelsynth::continuous {

// Triangles are merged into fewer faces, so there may be more of them than kFacesMax.
inline constexpr std::size_t kTrianglesMax = 100'000;

// An example out of a binary glTF 2.0 file: every closed part of a mesh of the scene is a solid.
//
// Frame:    that of the scene, so metres, y up, the ground at y = 0.
// Objects:  "object" in a node's extras is the object type of the whole node. Without it, the name
//           of the material of each of its primitives is ("object" when that has none), and what is
//           of different materials must be closed by itself. They are numbered as nodes come.
// Textures: of base colours, see glb_scene.h. How the file lays them is not read: models have them
//           upright on every face, in their size.
// Ground:   a flat, horizontal node at y = 0 with "ground": true (or 1) in its extras, or of
//           an object called "ground", is no solid but says that its object fills all below.
// Shapes:   a node whose extras have the name of an object for "shape" is no solid but that
//           object's shape, with "smooth" and "even" as in JSON examples.
// Decorations: a node with the name of an object for "decorates" is no solid but a decoration of
//           it, with "edges" or "corners", "turn", "turned" and "smooth" as in JSON examples. Its
//           mesh is put at corners as it is in the scene, its origin being the corner; or its
//           outline, along x and y of the scene from its origin, is the profile. It looks like the
//           object that it would be a solid of.
// Extras:   "weight", "shape" and "decorations" of the nodes and materials of an object, and of the
//           scene, or else the asset, the example's own fields, as in JSON examples. Others are
//           left alone, since programs write their own. They are not looked into.
// Noise:    corners closer than a millionth of the extent are one, and triangles that lie in a
//           plane within that are one face, if that face has no hole.
// Fails:    as read_glb_scene(); kTooLarge; kInvalidArgument with faults whose pointers are of the
//           file's JSON (/nodes/5) and which name the node and the triangle, counted from 0 over
//           the primitives of the node's mesh.
// Ensures:  find_solid_faults() finds nothing. The spacing is default_spacing().
// Cost:     O(n log n), the worst that is taken about a second. Thread-safe.
[[nodiscard]] Result<ImportedExample> read_example_glb(std::span<const std::byte> bytes);

}  // namespace modelsynth::continuous
