#pragma once

#include "solver/core/result.h"
#include "solver/mesh/glb_reader.h"

#include <cstddef>
#include <span>
#include <string>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace modelsynth {

[[nodiscard]] Error invalid_glb(std::string message);
[[nodiscard]] Error too_large_glb(std::string message);

// The document of a binary glTF file whose container is whole, whose JSON is not too deep, which
// requires no extension and has no more nodes than are taken. Its indices and ranges are not
// checked yet, and images are not read.
[[nodiscard]] Result<tinygltf::Model> parse_glb(
    std::span<const std::byte> bytes, const GlbReadLimits& limits
);

}  // namespace modelsynth
