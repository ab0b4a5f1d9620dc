#include "solver/discrete/default_kit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

namespace modelsynth::discrete {

namespace {

bool is_drawn(const Example& example, std::size_t label) {
    static constexpr std::array<std::string_view, 5> kUndrawn = {
        "air", "empty", "nothing", "sky", "void"};
    return example.empty != static_cast<Label>(label) &&
           std::find(kUndrawn.begin(), kUndrawn.end(), example.pieces[label].name) ==
               kUndrawn.end();
}

// Hues a golden angle apart, so that neighbours in the list look different.
Color color_of(std::size_t label) {
    const double hue = 6.0 * std::fmod(static_cast<double>(label) * 0.61803398875, 1.0);
    const auto part = [hue](double shift) {
        const double place = std::fmod(hue + shift, 6.0);
        const double value = std::clamp(std::fabs(place - 3.0) - 1.0, 0.0, 1.0);
        return static_cast<float>(std::round((0.12 + 0.55 * value) * 1024) / 1024);
    };
    return {part(0), part(4), part(2)};
}

// A box that leaves a narrow seam to its neighbours.
Mesh make_box(const Example& example, std::size_t label, std::uint32_t material) {
    constexpr float kSeam = 0.01F;
    const auto width = static_cast<float>(example.cell[0]) * (0.5F - kSeam);
    const auto height = static_cast<float>(example.cell[1]) * (1 - kSeam);
    const auto depth = static_cast<float>(example.cell[2]) * (0.5F - kSeam);
    Primitive primitive;
    primitive.material = material;

    // A face per direction: its normal and the two axes along it, counter-clockwise.
    struct Face {
        Vec3 normal;
        Vec3 u;
        Vec3 v;
    };

    static constexpr std::array<Face, kDirectionCount> kFaces = {
        {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
         {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
         {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
         {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
         {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
         {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}};
    for (const Face& face : kFaces) {
        const auto base = static_cast<std::uint32_t>(primitive.positions.size());
        for (const auto& [a, b] :
             {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
            const Vec3& n = face.normal;
            const Vec3 corner = {
                n.x + a * face.u.x + b * face.v.x,
                n.y + a * face.u.y + b * face.v.y,
                n.z + a * face.u.z + b * face.v.z};
            primitive.positions.push_back(
                {corner.x * width, corner.y > 0 ? height : 0.0F, corner.z * depth}
            );
            primitive.normals.push_back(n);
            const std::uint8_t shade = corner.y > 0 ? 255 : 190;
            primitive.colors.push_back({shade, shade, shade});
        }
        for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
            primitive.indices.push_back(base + corner);
        }
    }
    Mesh mesh = {example.pieces[label].name, {}};
    mesh.primitives.push_back(std::move(primitive));
    return mesh;
}

}  // namespace

void add_missing_meshes(Example& example) {
    Kit kit = *example.kit;
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        Piece& piece = example.pieces[label];
        if (piece.mesh || !is_drawn(example, label)) {
            continue;
        }
        const auto material = static_cast<std::uint32_t>(kit.materials.size());
        kit.materials.push_back({piece.name, color_of(label)});
        piece.mesh = static_cast<std::uint32_t>(kit.meshes.size());
        kit.meshes.push_back(make_box(example, label, material));
    }
    example.kit = std::make_shared<const Kit>(std::move(kit));
}

}  // namespace modelsynth::discrete
