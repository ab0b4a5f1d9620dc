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

// Bytes of the binary chunk and the tinygltf views and accessors over them.
class GltfBuffer {
  public:
    explicit GltfBuffer(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

    int positions(const std::vector<Vec3>& values) {
        const int accessor =
            add(values.data(), values.size(), sizeof(Vec3), TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        set_bounds(accessor, values);
        return accessor;
    }

    int normals(const std::vector<Vec3>& values) {
        const int accessor =
            add(values.data(), values.size(), sizeof(Vec3), TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        return accessor;
    }

    int texture_coordinates(const std::vector<Vec2>& values) {
        const int accessor =
            add(values.data(), values.size(), sizeof(Vec2), TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
        return accessor;
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
        const int accessor = add(parts.data(), values.size(), 8, TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
        model_.accessors.back().normalized = true;
        return accessor;
    }

    int indices(const std::vector<std::uint32_t>& values, std::size_t vertex_count) {
        if (vertex_count > 65535) {
            const int accessor =
                add(values.data(),
                    values.size(),
                    sizeof(std::uint32_t),
                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
            describe(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
            return accessor;
        }
        const std::vector<std::uint16_t> narrow(values.begin(), values.end());
        const int accessor =
            add(narrow.data(),
                narrow.size(),
                sizeof(std::uint16_t),
                TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR);
        return accessor;
    }

    // The number of the view, not of an accessor.
    int image(const std::string& bytes) { return add_view(bytes.data(), bytes.size()); }

    // Instance attributes: one view for all, without a target, since a view and bounds for each
    // would weigh more than the numbers themselves. Call it last, and add nothing after it.
    int translations(const std::vector<Vec3>& values) {
        if (translations_view_ < 0) {
            translations_view_ = static_cast<int>(model_.bufferViews.size());
            tinygltf::BufferView view;
            view.buffer = 0;
            view.byteOffset = data().size();
            model_.bufferViews.push_back(std::move(view));
        }
        auto& view = model_.bufferViews[static_cast<std::size_t>(translations_view_)];
        tinygltf::Accessor accessor;
        accessor.bufferView = translations_view_;
        accessor.byteOffset = view.byteLength;
        accessor.count = values.size();
        accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
        accessor.type = TINYGLTF_TYPE_VEC3;
        model_.accessors.push_back(std::move(accessor));
        const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
        data().insert(data().end(), bytes, bytes + values.size() * sizeof(Vec3));
        view.byteLength += values.size() * sizeof(Vec3);
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    [[nodiscard]] std::size_t bytes() const { return data().size(); }

    // Makes room for so much more, since to grow bit by bit is to copy and to touch fresh pages.
    void reserve(std::size_t more) { data().reserve(data().size() + more); }

  private:
    int add_view(const void* values, std::size_t length, int target = 0) {
        const std::size_t offset = data().size();
        const auto* bytes = static_cast<const unsigned char*>(values);
        data().insert(data().end(), bytes, bytes + length);
        data().resize(padded(data().size()));
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = offset;
        view.byteLength = length;
        view.target = target;
        model_.bufferViews.push_back(std::move(view));
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    int add(const void* values, std::size_t count, std::size_t stride, int target) {
        tinygltf::Accessor accessor;
        accessor.bufferView = add_view(values, count * stride, target);
        accessor.count = count;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    void describe(int accessor, int component_type, int type) {
        auto& described = model_.accessors[static_cast<std::size_t>(accessor)];
        described.componentType = component_type;
        described.type = type;
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

    [[nodiscard]] std::vector<unsigned char>& data() { return model_.buffers[0].data; }

    [[nodiscard]] const std::vector<unsigned char>& data() const { return model_.buffers[0].data; }

    tinygltf::Model& model_;
    int translations_view_ = -1;
};

}  // namespace modelsynth
