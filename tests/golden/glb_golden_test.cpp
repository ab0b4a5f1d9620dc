// The three profiles of a small scene: the JSON as it is, the buffer as a hash.

#include "solver/mesh/glb_writer.h"
#include "tests/golden/golden.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace modelsynth {
namespace {

Mesh make_triangle(const std::string& name, std::uint32_t material) {
    Primitive primitive;
    primitive.material = material;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0.5F, 0}};
    primitive.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    primitive.colors = {{255, 255, 255}, {128, 64, 0}, {0, 0, 0}};
    primitive.indices = {0, 1, 2};
    return {name, {primitive}};
}

Scene make_scene() {
    auto kit = std::make_shared<Kit>();
    kit->materials = {
        {"stone", {0.5F, 0.25F, 0.125F}, 0, 0.9F, {0, 0, 0}, false},
        {"lamp", {1, 1, 1}, 0.5F, 0.25F, {1, 0.5F, 0}, true},
        {"unused", {1, 0, 0}, 0, 1, {0, 0, 0}, false}};
    kit->meshes = {make_triangle("wall", 0), make_triangle("light", 1), make_triangle("none", 2)};
    Scene scene;
    scene.kit = kit;
    scene.names = {"wall", "wall turned", "light \"1\""};
    scene.groups = {
        {"column 0 0", {{0, 0, {0, 0, 0}, 0}, {0, 1, {2, 0, 0}, 1}, {0, 1, {4, 0, 0}, 1}}},
        {"column 1 0", {{1, 2, {10.5F, 1, -3}, 2}, {0, 0, {12, 0, 0}, 3}}}};
    return scene;
}

std::string describe(const std::string& glb) {
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, glb.data() + 12, 4);
    const std::string json = glb.substr(20, json_bytes);
    return json.substr(0, json.find_last_not_of(' ') + 1) + "\n" + std::to_string(glb.size()) +
           " bytes, buffer " + testing::sha256_hex(std::string_view(glb).substr(20 + json_bytes)) +
           "\n";
}

TEST(Golden, GlbProfiles) {
    std::string text;
    for (const auto profile : {GlbProfile::kNodes, GlbProfile::kInstanced, GlbProfile::kMerged}) {
        GlbOptions options;
        options.profile = profile;
        const auto glb = write_glb(make_scene(), options);
        ASSERT_TRUE(glb) << glb.error().message;
        text += describe(*glb);
    }
    testing::expect_golden("glb.txt", text);
}

}  // namespace
}  // namespace modelsynth
