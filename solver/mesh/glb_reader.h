#pragma once

#include "solver/core/result.h"
#include "solver/mesh/mesh.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace modelsynth {

struct GlbReadLimits {
    std::size_t bytes_max = std::size_t{64} << 20;
    std::size_t nodes_max = 65536;
    std::size_t vertices_max = 4'000'000;
    std::size_t json_depth_max = 64;
    std::size_t image_bytes_max = kImageBytesMax;  // of all textures together
};

// The named nodes of a binary glTF 2.0 file, each as one mesh named as the node, with all its
// descendants. A node's own translation is left out, so that pieces laid out side by side come
// back to the origin; its rotation and scale hold. Nodes without a name of their own take the
// name of their mesh.
//
// Taken: triangles with POSITION, optional NORMAL (flat ones are made) and COLOR_0, metal-rough
// materials. Refused, by name: anything the file requires beyond core glTF, textures, other
// primitive modes, sparse accessors, external files, cyclic or shared node trees, accessors that
// reach beyond their buffer, numbers that are not finite.
// Hostile input is expected; nothing outside `bytes` is read. Fails: kInvalidArgument, kTooLarge.
[[nodiscard]] Result<Kit> read_glb(
    std::span<const std::byte> bytes, const GlbReadLimits& limits = {}
);

}  // namespace modelsynth
