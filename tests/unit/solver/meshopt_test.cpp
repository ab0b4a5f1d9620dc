// What EXT_meshopt_compression leaves of a file, decoded, is the file as it would be without.

#include "solver/continuous/scene.h"
#include "solver/discrete/scene.h"
#include "solver/examples/all.h"
#include "solver/examples/built_in.h"
#include "solver/mesh/glb_reader.h"
#include "solver/mesh/glb_writer.h"
#include "solver/registry/task.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace modelsynth {
namespace {

using nlohmann::json;

struct Glb {
    json document;
    std::string binary;
};

Glb taken_apart(const std::string& glb) {
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, glb.data() + 12, 4);
    Glb parts;
    parts.document = json::parse(glb.substr(20, json_bytes));
    if (glb.size() > 28 + json_bytes) {
        parts.binary = glb.substr(28 + json_bytes);
    }
    return parts;
}

std::string write(const Scene& scene, GlbProfile profile, GlbCompression compression) {
    GlbOptions options;
    options.profile = profile;
    options.compression = compression;
    return *write_glb(scene, options);
}

std::string bytes_of_view(const Glb& glb, const json& place) {
    return glb.binary.substr(
        place.value("byteOffset", std::size_t{0}), place.at("byteLength").get<std::size_t>()
    );
}

std::string decoded(const Glb& glb, const json& view) {
    const json extension = view.at("extensions").at("EXT_meshopt_compression");
    const std::string encoded = bytes_of_view(glb, extension);
    const auto* data = reinterpret_cast<const unsigned char*>(encoded.data());
    const std::size_t count = extension.at("count");
    const std::size_t stride = extension.at("byteStride");
    EXPECT_EQ(extension.at("buffer"), 0);
    EXPECT_FALSE(extension.contains("filter"));
    EXPECT_EQ(count * stride, view.at("byteLength"));
    // The format that the extension names; later ones are not part of it.
    const bool is_indices = extension.at("mode") == "INDICES";
    EXPECT_EQ(data[0], is_indices ? 0xD1 : 0xA0);
    std::string bytes(count * stride, '\0');
    const int fault =
        is_indices ? meshopt_decodeIndexSequence(bytes.data(), count, stride, data, encoded.size())
                   : meshopt_decodeVertexBuffer(bytes.data(), count, stride, data, encoded.size());
    EXPECT_EQ(fault, 0);
    return bytes;
}

void expect_same(const Scene& scene, GlbProfile profile) {
    const std::string compressed_file = write(scene, profile, GlbCompression::kMeshopt);
    EXPECT_EQ(compressed_file, write(scene, profile, GlbCompression::kMeshopt));
    Glb plain = taken_apart(write(scene, profile, GlbCompression::kNone));
    Glb compressed = taken_apart(compressed_file);
    EXPECT_LT(compressed.binary.size(), plain.binary.size());

    std::size_t fallback_end = 0;
    ASSERT_EQ(plain.document["bufferViews"].size(), compressed.document["bufferViews"].size());
    for (std::size_t i = 0; i < plain.document["bufferViews"].size(); ++i) {
        const json& before = plain.document["bufferViews"][i];
        const json& after = compressed.document["bufferViews"][i];
        if (!after.contains("extensions")) {
            EXPECT_EQ(after.at("buffer"), 0);
            EXPECT_EQ(bytes_of_view(compressed, after), bytes_of_view(plain, before));
            continue;
        }
        EXPECT_EQ(after.at("buffer"), 1);
        EXPECT_EQ(after.value("target", 0), before.value("target", 0));
        EXPECT_EQ(decoded(compressed, after), bytes_of_view(plain, before));
        // Views of the fallback buffer do not overlap.
        EXPECT_GE(after.value("byteOffset", std::size_t{0}), fallback_end);
        fallback_end =
            after.at("byteOffset").get<std::size_t>() + after.at("byteLength").get<std::size_t>();
    }
    const json& buffers = compressed.document["buffers"];
    ASSERT_EQ(buffers.size(), 2U);
    EXPECT_EQ(buffers[0].at("byteLength"), compressed.binary.size());
    EXPECT_GE(buffers[1].at("byteLength").get<std::size_t>(), fallback_end);
    EXPECT_EQ(buffers[1].at("extensions").at("EXT_meshopt_compression").at("fallback"), true);

    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        json& names = compressed.document[list];
        ASSERT_EQ(names.back(), "EXT_meshopt_compression");
        names.erase(names.size() - 1);
        if (names.empty()) {
            compressed.document.erase(list);
        }
    }
    // All else is the same: nodes, meshes, materials, accessors with their bounds.
    for (json* document : {&plain.document, &compressed.document}) {
        document->erase("buffers");
        document->erase("bufferViews");
    }
    EXPECT_EQ(plain.document, compressed.document);
}

constexpr std::array<GlbProfile, 3> kProfiles = {
    GlbProfile::kNodes, GlbProfile::kInstanced, GlbProfile::kMerged};

TEST(Meshopt, LeavesGridsAsTheyAre) {
    const auto& castle = *examples::built_in().front();
    const Scene scene =
        discrete::make_scene(castle, castle.size, castle.cells, Box::whole(castle.size));
    for (const GlbProfile profile : kProfiles) {
        expect_same(scene, profile);
    }
}

TEST(Meshopt, LeavesSolidsAsTheyAre) {
    const Scene scene = example_scene(*examples::find("domes"));
    for (const GlbProfile profile : kProfiles) {
        expect_same(scene, profile);
    }
}

Primitive strip(std::size_t triangles) {
    Primitive primitive;
    for (std::uint32_t i = 0; i < triangles + 2; ++i) {
        primitive.positions.push_back({static_cast<float>(i), i % 2 == 0 ? 0.0F : 1e-30F, -0.0F});
        primitive.normals.push_back({0, 0, 1});
        primitive.colors.push_back({static_cast<std::uint8_t>(i * 7 % 256), 255, 0});
        primitive.texture_coordinates.push_back({static_cast<float>(i) / 3, 0.1F});
    }
    for (std::uint32_t i = 0; i < triangles; ++i) {
        // Corners in every turn, which a coder of triangles would not keep.
        const std::array<std::uint32_t, 3> corners = {i, i + 1 + i % 2, i + 2 - i % 2};
        for (std::uint32_t k = 0; k < 3; ++k) {
            primitive.indices.push_back(corners[(k + i) % 3]);
        }
    }
    return primitive;
}

Scene scene_of(Primitive primitive, std::shared_ptr<const Image> image) {
    auto kit = std::make_shared<Kit>();
    Material material = {"tiles", {}};
    if (image) {
        material.texture = Texture{std::move(image), 2.0F};
    }
    kit->materials = {material};
    kit->meshes = {{"strip", {std::move(primitive)}}};
    Scene scene;
    scene.kit = kit;
    scene.names = {"strip"};
    scene.groups = {{"column", {{0, 0, {0.1F, 0, 0}, 0}, {0, 0, {2, 0, 0}, 3}}}};
    return scene;
}

TEST(Meshopt, LeavesImagesOutsideOfIt) {
    auto image = std::make_shared<Image>();
    image->format = ImageFormat::kPng;
    image->bytes = "bytes that are not looked at";
    const Scene scene = scene_of(strip(300), image);
    for (const GlbProfile profile : kProfiles) {
        expect_same(scene, profile);
        const auto glb = write(scene, profile, GlbCompression::kMeshopt);
        EXPECT_NE(glb.find(image->bytes), std::string::npos);
    }
}

TEST(Meshopt, LeavesLargeIndicesAsTheyAre) {
    expect_same(scene_of(strip(70'000), nullptr), GlbProfile::kNodes);
}

TEST(Meshopt, KeepsAFileOfNothingAsItIs) {
    const Scene nothing;
    EXPECT_EQ(
        write(nothing, GlbProfile::kNodes, GlbCompression::kMeshopt),
        write(nothing, GlbProfile::kNodes, GlbCompression::kNone)
    );
}

TEST(Meshopt, IsRefusedByTheReader) {
    const auto glb =
        write(scene_of(strip(9), nullptr), GlbProfile::kNodes, GlbCompression::kMeshopt);
    const auto kit = read_glb(std::as_bytes(std::span(glb)));
    ASSERT_FALSE(kit);
    EXPECT_NE(kit.error().message.find("EXT_meshopt_compression"), std::string::npos)
        << kit.error().message;
}

}  // namespace
}  // namespace modelsynth
