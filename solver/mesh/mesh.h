#pragma once

#include "solver/mesh/texture.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth {

// A point or direction; metres, right-handed, y up.
struct Vec3 {
    float x = 0;
    float y = 0;
    float z = 0;

    friend bool operator==(const Vec3&, const Vec3&) = default;
};

// A point in a picture: x to the right, y downwards.
struct Vec2 {
    float x = 0;
    float y = 0;

    friend bool operator==(const Vec2&, const Vec2&) = default;
};

// A linear (not sRGB) colour, each part 0 ... 1.
struct Color {
    float r = 1;
    float g = 1;
    float b = 1;

    friend bool operator==(const Color&, const Color&) = default;
};

// A glTF metallic-roughness material. Its texture multiplies the base colour; what has one needs
// texture coordinates, counted in repeats of the picture.
struct Material {
    std::string name;
    Color base_color;
    float metallic = 0;
    float roughness = 0.9F;
    Color emissive = {0, 0, 0};
    bool double_sided = false;
    std::optional<Texture> texture = std::nullopt;

    friend bool operator==(const Material&, const Material&) = default;
};

// Triangles of one material, one at least: glTF has no parts of meshes without. positions, normals
// and colors have one entry per vertex; a colour is linear RGB in 0 ... 255 that multiplies the
// material's. texture_coordinates has one entry per vertex or none at all. Front faces are
// counter-clockwise.
struct Primitive {
    std::uint32_t material = 0;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<std::array<std::uint8_t, 3>> colors;
    std::vector<Vec2> texture_coordinates;
    std::vector<std::uint32_t> indices;
};

// What one piece looks like. Its origin is the middle of the cell's floor: a piece of a cell of
// size (a, b, c) fills -a/2 ... a/2, 0 ... b, -c/2 ... c/2.
struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
};

// The meshes of all pieces of an example and the materials they share.
struct Kit {
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
};

}  // namespace modelsynth
