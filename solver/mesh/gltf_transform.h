#pragma once

#include <array>
#include <cstddef>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace modelsynth {

// A 3x4 matrix: columns for x, y, z and the translation.
struct Transform {
    std::array<std::array<double, 3>, 4> columns = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

    [[nodiscard]] std::array<double, 3> turn(const std::array<double, 3>& v) const {
        std::array<double, 3> result = {};
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                result[row] += columns[column][row] * v[column];
            }
        }
        return result;
    }

    [[nodiscard]] std::array<double, 3> place(const std::array<double, 3>& v) const {
        auto result = turn(v);
        for (std::size_t row = 0; row < 3; ++row) {
            result[row] += columns[3][row];
        }
        return result;
    }

    // First `inner`, then this.
    [[nodiscard]] Transform after(const Transform& inner) const {
        Transform result;
        for (std::size_t column = 0; column < 3; ++column) {
            result.columns[column] = turn(inner.columns[column]);
        }
        result.columns[3] = place(inner.columns[3]);
        return result;
    }

    [[nodiscard]] double determinant() const {
        const auto& [a, b, c, t] = columns;
        return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
               c[0] * (a[1] * b[2] - a[2] * b[1]);
    }
};

inline Transform local_transform(const tinygltf::Node& node) {
    Transform result;
    if (node.matrix.size() == 16) {
        for (std::size_t column = 0; column < 4; ++column) {
            for (std::size_t row = 0; row < 3; ++row) {
                result.columns[column][row] = node.matrix[column * 4 + row];
            }
        }
        return result;
    }
    if (node.rotation.size() == 4) {
        const double x = node.rotation[0];
        const double y = node.rotation[1];
        const double z = node.rotation[2];
        const double w = node.rotation[3];
        result.columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
        result.columns[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
        result.columns[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    }
    if (node.scale.size() == 3) {
        for (std::size_t column = 0; column < 3; ++column) {
            for (double& part : result.columns[column]) {
                part *= node.scale[column];
            }
        }
    }
    if (node.translation.size() == 3) {
        result.columns[3] = {node.translation[0], node.translation[1], node.translation[2]};
    }
    return result;
}

}  // namespace modelsynth
