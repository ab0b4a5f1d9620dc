#pragma once

#include <string>
#include <vector>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace modelsynth {

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

// A file's binary chunk, and the parts of its JSON that tell what stands where in it.
struct CompressedBuffers {
    std::vector<unsigned char> binary;
    std::string buffers;       // JSON array
    std::string buffer_views;  // JSON array, numbered as those of the model
};

// What accessors read, compressed as EXT_meshopt_compression says: without filters, so that a
// reader that decodes it has every byte as it was. Views that no accessor reads, which are images,
// stay as they are. The second buffer is the fallback buffer of the extension and has no bytes: a
// reader without the extension cannot read the file, so the extension must be required.
// `parts`: what each view holds. Requires: no empty part; what accessors read of a view is tightly
// packed, of one size, a multiple of four bytes for attributes (checked).
// Deterministic for one version of meshoptimizer. Thread-safe.
[[nodiscard]] CompressedBuffers compress_buffers(
    const tinygltf::Model& model, const std::vector<std::vector<unsigned char>>& parts
);

}  // namespace modelsynth
