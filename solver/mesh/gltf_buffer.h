#pragma once

#include "solver/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace modelsynth {

// Chunks and views begin at multiples of four bytes.
[[nodiscard]] constexpr std::size_t padded(std::size_t length) { return (length + 3) / 4 * 4; }

// The bytes of the binary chunk, and the tinygltf views and accessors over them. What is of one
// kind, all positions say, shares a view: with a view for each accessor they were a seventh of the
// JSON of a castle.
class GltfBuffer {
  public:
    explicit GltfBuffer(tinygltf::Model& model) : model_(model) { views_.fill(-1); }

    // How many there will be at least, since to grow bit by bit is to copy. Before the first.
    void expect(std::size_t vertices, std::size_t indices) {
        expected_ = {vertices, vertices, vertices, 0, indices, 0, 0};
    }

    int positions(const std::vector<Vec3>& values) {
        const int accessor = add(kPositions, values.data(), values.size());
        set_bounds(accessor, values);
        return accessor;
    }

    int normals(const std::vector<Vec3>& values) {
        return add(kNormals, values.data(), values.size());
    }

    int texture_coordinates(const std::vector<Vec2>& values) {
        return add(kTextureCoordinates, values.data(), values.size());
    }

    // Vertex colours times the material's colour, RGB as RGBA in 16 bits each: some readers (VTK)
    // take vertex colours in place of the material's instead of multiplying them, and eight
    // linear bits are too few for dark colours.
    int colors(const std::vector<std::array<std::uint8_t, 3>>& values, const Color& base) {
        const auto part = [](std::uint8_t value, float factor) {
            return static_cast<std::uint16_t>(std::lround(double{factor} * value * 257.0));
        };
        std::vector<std::uint16_t> parts;
        parts.reserve(values.size() * 4);
        for (const auto& color : values) {
            parts.insert(
                parts.end(),
                {part(color[0], base.r), part(color[1], base.g), part(color[2], base.b), 65535}
            );
        }
        const int accessor = add(kColors, parts.data(), values.size());
        model_.accessors.back().normalized = true;
        return accessor;
    }

    int indices(const std::vector<std::uint32_t>& values, std::size_t vertex_count) {
        if (vertex_count > 65535) {
            return add(kWideIndices, values.data(), values.size());
        }
        const std::vector<std::uint16_t> narrow(values.begin(), values.end());
        return add(kIndices, narrow.data(), narrow.size());
    }

    // Instance attributes: no vertices, so their view has no target.
    int translations(const std::vector<Vec3>& values) {
        return add(kTranslations, values.data(), values.size());
    }

    // The number of the view, not of an accessor.
    int image(const std::string& bytes) {
        const int number = add_view();
        parts_.back().assign(bytes.begin(), bytes.end());
        total_ += bytes.size();
        return number;
    }

    [[nodiscard]] std::size_t bytes() const { return total_; }

    // What each view holds, once its model is complete: puts the views one after the other.
    const std::vector<std::vector<unsigned char>>& finish() {
        std::size_t offset = 0;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            model_.bufferViews[i].byteOffset = offset;
            model_.bufferViews[i].byteLength = parts_[i].size();
            offset += padded(parts_[i].size());
        }
        return parts_;
    }

  private:
    enum Kind : std::size_t {
        kPositions,
        kNormals,
        kColors,
        kTextureCoordinates,
        kIndices,
        kWideIndices,
        kTranslations,
        kKinds
    };

    static constexpr std::array<std::size_t, kKinds> kStrides = {
        sizeof(Vec3), sizeof(Vec3), 8, sizeof(Vec2), 2, 4, sizeof(Vec3)};
    static constexpr std::array<int, kKinds> kTargets = {
        TINYGLTF_TARGET_ARRAY_BUFFER,
        TINYGLTF_TARGET_ARRAY_BUFFER,
        TINYGLTF_TARGET_ARRAY_BUFFER,
        TINYGLTF_TARGET_ARRAY_BUFFER,
        TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
        TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
        0};
    static constexpr std::array<int, kKinds> kComponents = {
        TINYGLTF_COMPONENT_TYPE_FLOAT,
        TINYGLTF_COMPONENT_TYPE_FLOAT,
        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
        TINYGLTF_COMPONENT_TYPE_FLOAT,
        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
        TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
        TINYGLTF_COMPONENT_TYPE_FLOAT};
    static constexpr std::array<int, kKinds> kTypes = {
        TINYGLTF_TYPE_VEC3,
        TINYGLTF_TYPE_VEC3,
        TINYGLTF_TYPE_VEC4,
        TINYGLTF_TYPE_VEC2,
        TINYGLTF_TYPE_SCALAR,
        TINYGLTF_TYPE_SCALAR,
        TINYGLTF_TYPE_VEC3};

    int add_view() {
        model_.bufferViews.emplace_back();
        model_.bufferViews.back().buffer = 0;
        parts_.emplace_back();
        return static_cast<int>(parts_.size()) - 1;
    }

    std::vector<unsigned char>& part(Kind kind) {
        if (views_[kind] < 0) {
            views_[kind] = add_view();
            auto& view = model_.bufferViews.back();
            view.target = kTargets[kind];
            // glTF wants it of vertices that share a view, and nowhere else.
            view.byteStride = view.target == TINYGLTF_TARGET_ARRAY_BUFFER ? kStrides[kind] : 0;
            parts_.back().reserve(expected_[kind] * kStrides[kind]);
        }
        return parts_[static_cast<std::size_t>(views_[kind])];
    }

    int add(Kind kind, const void* values, std::size_t count) {
        std::vector<unsigned char>& bytes = part(kind);
        tinygltf::Accessor accessor;
        accessor.bufferView = views_[kind];
        accessor.byteOffset = bytes.size();
        accessor.count = count;
        accessor.componentType = kComponents[kind];
        accessor.type = kTypes[kind];
        model_.accessors.push_back(std::move(accessor));
        const std::size_t length = count * kStrides[kind];
        const auto* first = static_cast<const unsigned char*>(values);
        bytes.insert(bytes.end(), first, first + length);
        total_ += length;
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    void set_bounds(int accessor, const std::vector<Vec3>& values) {
        Vec3 low = values.front();
        Vec3 high = low;
        for (const Vec3& v : values) {
            low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
            high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
        }
        const auto widen = [](const Vec3& v) {
            return std::vector<double>{double{v.x}, double{v.y}, double{v.z}};
        };
        auto& described = model_.accessors[static_cast<std::size_t>(accessor)];
        described.minValues = widen(low);
        described.maxValues = widen(high);
    }

    tinygltf::Model& model_;
    std::vector<std::vector<unsigned char>> parts_;  // by the number of the view
    std::array<int, kKinds> views_;                  // -1: none yet
    std::array<std::size_t, kKinds> expected_ = {};
    std::size_t total_ = 0;
};

}  // namespace modelsynth
