#pragma once

#include "solver/core/result.h"
#include "solver/mesh/gltf_document.h"
#include "solver/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {

// Reads numbers out of accessors, each access within its buffer.
class AccessorReader {
  public:
    AccessorReader(const tinygltf::Model& model, std::size_t vertices_max)
        : model_(model), vertices_left_(vertices_max) {}

    // The rows of an accessor as doubles, normalised integers as fractions.
    Result<std::vector<std::array<double, 4>>> rows(int index, const std::string& what) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) {
            return tl::unexpected(invalid_glb(what + " has no accessor"));
        }
        const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
        const std::string name = what + " (accessor " + std::to_string(index) + ")";
        if (accessor.sparse.isSparse) {
            return tl::unexpected(invalid_glb(name + " is sparse"));
        }
        const auto views = model_.bufferViews.size();
        if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= views) {
            return tl::unexpected(invalid_glb(name + " has no buffer view"));
        }
        const tinygltf::BufferView& view =
            model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
            return tl::unexpected(invalid_glb(name + " has no buffer"));
        }
        const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
        const int component_bytes =
            tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
        const int components =
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
        if (component_bytes <= 0 || components <= 0 || components > 4) {
            return tl::unexpected(invalid_glb(name + " has an unknown type"));
        }
        const auto row_bytes = static_cast<std::size_t>(component_bytes * components);
        const std::size_t stride = view.byteStride == 0 ? row_bytes : view.byteStride;
        if (accessor.count > vertices_left_) {
            return tl::unexpected(too_large_glb("has more vertices than are taken"));
        }
        vertices_left_ -= accessor.count;
        const bool view_fits =
            view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset;
        const bool rows_fit =
            view_fits && accessor.byteOffset <= view.byteLength && stride >= row_bytes &&
            accessor.count > 0 && row_bytes <= view.byteLength - accessor.byteOffset &&
            (accessor.count - 1) <= (view.byteLength - accessor.byteOffset - row_bytes) / stride;
        if (!rows_fit) {
            return tl::unexpected(invalid_glb(name + " reaches beyond its buffer"));
        }
        std::vector<std::array<double, 4>> result(accessor.count);
        const unsigned char* from = data.data() + view.byteOffset + accessor.byteOffset;
        for (std::size_t row = 0; row < accessor.count; ++row) {
            for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) {
                result[row][c] = number(
                    from + row * stride + c * static_cast<std::size_t>(component_bytes),
                    accessor.componentType,
                    accessor.normalized
                );
                if (!std::isfinite(result[row][c]) || std::fabs(result[row][c]) > 1e9) {
                    return tl::unexpected(invalid_glb(name + " has a number that is not usable"));
                }
            }
        }
        return result;
    }

  private:
    template <class T>
    static double read(const unsigned char* from, bool normalised) {
        T value;
        std::memcpy(&value, from, sizeof value);
        const auto number = static_cast<double>(value);
        return normalised ? number / static_cast<double>(std::numeric_limits<T>::max()) : number;
    }

    static double number(const unsigned char* from, int type, bool normalised) {
        switch (type) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return read<std::int8_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return read<std::uint8_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return read<std::int16_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return read<std::uint16_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                return read<std::uint32_t>(from, false);
            case TINYGLTF_COMPONENT_TYPE_FLOAT:
                return read<float>(from, false);
            default:
                return std::nan("");
        }
    }

    const tinygltf::Model& model_;
    std::size_t vertices_left_;
};

}  // namespace modelsynth
