#include "solver/mesh/gltf_document.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace modelsynth {

namespace {

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
    }
    return value;
}

// How deep the brackets of a JSON text nest, strings left out.
std::size_t nesting_depth(std::span<const std::byte> json) {
    std::size_t depth = 0;
    std::size_t deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = static_cast<char>(json[i]);
        if (in_string) {
            i += c == '\\' ? 1U : 0U;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

// No binary glTF at all.
Error malformed_glb(std::string message) {
    Error error = invalid_glb(std::move(message));
    error.code = ErrorCode::kMalformed;
    return error;
}

Result<void> check_container(std::span<const std::byte> bytes, const GlbReadLimits& limits) {
    if (bytes.size() > limits.bytes_max) {
        return tl::unexpected(
            too_large_glb("larger than " + std::to_string(limits.bytes_max) + " bytes")
        );
    }
    if (bytes.size() < 20 || std::memcmp(bytes.data(), "glTF", 4) != 0) {
        return tl::unexpected(malformed_glb("does not begin with a binary glTF header"));
    }
    if (read_u32(bytes, 4) != 2) {
        return tl::unexpected(malformed_glb("is not of version 2"));
    }
    if (read_u32(bytes, 8) != bytes.size()) {
        return tl::unexpected(malformed_glb(
            "says it has " + std::to_string(read_u32(bytes, 8)) + " bytes and has " +
            std::to_string(bytes.size())
        ));
    }
    const std::size_t json_size = read_u32(bytes, 12);
    if (json_size > bytes.size() - 20 || std::memcmp(bytes.data() + 16, "JSON", 4) != 0) {
        return tl::unexpected(malformed_glb("has no whole JSON chunk"));
    }
    if (nesting_depth(bytes.subspan(20, json_size)) > limits.json_depth_max) {
        return tl::unexpected(
            malformed_glb("its JSON nests deeper than " + std::to_string(limits.json_depth_max))
        );
    }
    const std::size_t binary_at = 20 + json_size;
    if (binary_at == bytes.size()) {
        return {};
    }
    if (bytes.size() - binary_at < 8 || read_u32(bytes, binary_at) > bytes.size() - binary_at - 8) {
        return tl::unexpected(malformed_glb("has no whole binary chunk"));
    }
    return {};
}

Result<tinygltf::Model> parse_document(std::span<const std::byte> bytes) {
    tinygltf::TinyGLTF loader;
    loader.SetStoreOriginalJSONForExtrasAndExtensions(true);
    tinygltf::FsCallbacks no_files = {};
    no_files.FileExists = [](const std::string&, void*) { return false; };
    no_files.ExpandFilePath = [](const std::string&, void*) { return std::string(); };
    no_files.ReadWholeFile =
        [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; };
    no_files.WriteWholeFile =
        [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
            return false;
        };
    loader.SetFsCallbacks(no_files);
    loader.SetImageLoader(
        [](tinygltf::Image*,
           int,
           std::string*,
           std::string*,
           int,
           int,
           const unsigned char*,
           int,
           void*) { return true; },
        nullptr
    );
    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    const bool loaded = loader.LoadBinaryFromMemory(
        &model,
        &errors,
        &warnings,
        reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<unsigned int>(bytes.size())
    );
    // Such a file may well fail for what its extension allows.
    if (!model.extensionsRequired.empty()) {
        return tl::unexpected(invalid_glb(
            "requires the extension " + model.extensionsRequired.front() + ", which is not taken"
        ));
    }
    if (!loaded) {
        if (errors.find("json.exception") != std::string::npos) {
            return tl::unexpected(malformed_glb("its JSON is malformed"));
        }
        const std::string first_line = errors.substr(0, errors.find('\n'));
        return tl::unexpected(invalid_glb("cannot be read: " + first_line.substr(0, 200)));
    }
    return model;
}

}  // namespace

Error invalid_glb(std::string message) {
    return {ErrorCode::kInvalidArgument, "GLB: " + std::move(message), {}};
}

Error too_large_glb(std::string message) {
    return {ErrorCode::kTooLarge, "GLB: " + std::move(message), {}};
}

Result<tinygltf::Model> parse_glb(std::span<const std::byte> bytes, const GlbReadLimits& limits) {
    if (auto fine = check_container(bytes, limits); !fine) {
        return tl::unexpected(std::move(fine.error()));
    }
    auto model = parse_document(bytes);
    if (!model) {
        return model;
    }
    if (model->nodes.size() > limits.nodes_max) {
        return tl::unexpected(
            too_large_glb("has more than " + std::to_string(limits.nodes_max) + " nodes")
        );
    }
    return model;
}

}  // namespace modelsynth
