#pragma once

#include "solver/core/result.h"
#include "solver/mesh/glb_reader.h"
#include "solver/mesh/mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace modelsynth {

// What a file says beyond glTF ("extras"): any JSON.
struct Extra {
    // A class of its own: clang looks into a pair while it is still incomplete.
    struct Member;
    using List = std::vector<Extra>;
    using Members = std::vector<Member>;  // by name

    std::variant<std::monostate, bool, double, std::string, List, Members> value;

    // The member of that name; null when there is none, or when this is no object.
    [[nodiscard]] const Extra* find(std::string_view name) const;

    friend bool operator==(const Extra& a, const Extra& b);
};

struct Extra::Member {
    std::string name;
    Extra extra;

    friend bool operator==(const Member&, const Member&) = default;
};

// A node that has a mesh.
struct GlbNode {
    std::size_t number = 0;  // in the file's list of nodes
    std::string name;        // its own, not that of its mesh
    std::uint32_t mesh = 0;  // index into GlbScene::kit.meshes
    // The node in the scene: where x, y and z of the mesh point, and where its origin is.
    std::array<std::array<double, 3>, 4> frame = {};
    Extra extras;
};

// A scene as it stands, other than the kit that read_glb() makes of it.
struct GlbScene {
    Kit kit;                             // meshes as they are in the file, in their own frames
    std::vector<Extra> material_extras;  // by material of the kit
    std::vector<GlbNode> nodes;
    std::size_t number = 0;  // in the file's list of scenes
    Extra extras;            // of the scene
    Extra asset_extras;      // of the file
};

// The default scene of a binary glTF 2.0 file, or else its first, or else all its nodes.
// Taken and refused, and hostile input: as read_glb(), but that a material may have a texture of
// its base colour: a PNG or JPEG in a buffer view, as its first bytes and its mimeType say.
// "metres" in the material's extras is how wide and how high the picture is, 1 if nothing is said.
// Textures of other kinds are refused; sampler and texture coordinates are not read.
// Fails: kInvalidArgument, kTooLarge.
[[nodiscard]] Result<GlbScene> read_glb_scene(
    std::span<const std::byte> bytes, const GlbReadLimits& limits = {}
);

}  // namespace modelsynth
