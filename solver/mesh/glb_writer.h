#pragma once

#include "solver/core/result.h"
#include "solver/mesh/scene.h"

#include <cstdint>
#include <string>

namespace modelsynth {

// How a scene becomes glTF.
enum class GlbProfile : std::uint8_t {
    kNodes,      // core glTF, a node per instance; every reader opens it
    kInstanced,  // EXT_mesh_gpu_instancing, required; a node per mesh, turn and group; small
    kMerged,     // core glTF, one mesh per group with its materials' primitives joined; large
};

// How the numbers of meshes and instances are kept.
enum class GlbCompression : std::uint8_t {
    kNone,
    kMeshopt,  // EXT_meshopt_compression, required; decoded, every byte is as with kNone
};

struct GlbOptions {
    GlbProfile profile = GlbProfile::kNodes;
    GlbCompression compression = GlbCompression::kNone;
    // kNodes: instance nodes are named as their piece. Names cost bytes, so models have them as
    // extras only.
    bool named_nodes = false;
    // Larger files are refused; glTF's own limit is 4 GiB, viewers stop near 2.
    std::size_t bytes_max = std::size_t{1} << 30;
};

// The scene as binary glTF 2.0. Deterministic; equal scenes give equal bytes.
// Texture coordinates are written as TEXCOORD_0 where there are any; kMerged keeps primitives that
// have none apart from those that do.
// Images are written as they are, each once, repeated in both directions.
// Meshes that no instance uses are left out, and materials and images that no mesh uses. With
// kNodes the instance nodes carry `extras.piece`, their name.
// Fails: kTooLarge. Cost: O(instances), for kMerged O(triangles). Thread-safe.
[[nodiscard]] Result<std::string> write_glb(const Scene& scene, const GlbOptions& options = {});

}  // namespace modelsynth
