#include "solver/discrete/scene.h"
#include "solver/examples/built_in.h"
#include "solver/mesh/glb_reader.h"
#include "solver/mesh/glb_writer.h"
#include "solver/mesh/gltf_accessors.h"
#include "solver/mesh/gltf_document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>

namespace modelsynth {
namespace {

Scene castle_scene() {
    const auto& castle = *examples::built_in().front();
    return discrete::make_scene(castle, castle.size, castle.cells, Box::whole(castle.size));
}

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

TEST(GlbWriter, EqualScenesGiveEqualBytesInEveryProfile) {
    for (const auto profile : {GlbProfile::kNodes, GlbProfile::kInstanced, GlbProfile::kMerged}) {
        GlbOptions options;
        options.profile = profile;
        const auto first = write_glb(castle_scene(), options);
        ASSERT_TRUE(first);
        EXPECT_EQ(*first, *write_glb(castle_scene(), options));
        EXPECT_EQ(first->size() % 4, 0U);
    }
}

TEST(GlbWriter, RefusesFilesOverTheLimitAtItsEdge) {
    GlbOptions options;
    const std::size_t size = write_glb(castle_scene())->size();
    options.bytes_max = size;
    EXPECT_TRUE(write_glb(castle_scene(), options));
    options.bytes_max = size - 1;
    EXPECT_EQ(write_glb(castle_scene(), options).error().code, ErrorCode::kTooLarge);
}

TEST(GlbWriter, AnEmptySceneIsAFileToo) { EXPECT_TRUE(write_glb(Scene{})); }

Primitive triangle(bool has_coordinates) {
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {4, 0, 0}, {0, 2, 0}};
    primitive.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    primitive.colors = {{255, 255, 255}, {255, 255, 255}, {255, 255, 255}};
    primitive.indices = {0, 1, 2};
    if (has_coordinates) {
        primitive.texture_coordinates = {{0, 0}, {4, 0}, {0, -2}};
    }
    return primitive;
}

TEST(GlbWriter, PrimitivesHaveTextureCoordinatesForEveryVertexOrNone) {
    auto kit = std::make_shared<Kit>();
    kit->materials = {{"stone", {}}};
    kit->meshes = {{"plain", {triangle(false)}}, {"both", {triangle(true), triangle(false)}}};
    Scene scene;
    scene.kit = kit;
    scene.names = {"plain", "both"};
    scene.groups = {{"column", {{0, 0, {0, 0, 0}, 0}, {1, 1, {2, 0, 0}, 1}, {1, 1, {4, 0, 0}, 0}}}};
    for (const auto profile : {GlbProfile::kNodes, GlbProfile::kInstanced, GlbProfile::kMerged}) {
        GlbOptions options;
        options.profile = profile;
        const std::string glb = *write_glb(scene, options);
        const auto model = parse_glb(bytes_of(glb), {});
        // What is instanced requires its extension, which no reader of ours takes.
        if (profile == GlbProfile::kInstanced) {
            EXPECT_NE(glb.find("\"TEXCOORD_0\""), std::string::npos);
            continue;
        }
        ASSERT_TRUE(model) << model.error().message;
        std::size_t textured = 0;
        std::size_t plain = 0;
        for (const tinygltf::Mesh& mesh : model->meshes) {
            for (const tinygltf::Primitive& primitive : mesh.primitives) {
                const auto vertices =
                    model->accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))]
                        .count;
                const auto found = primitive.attributes.find("TEXCOORD_0");
                if (found == primitive.attributes.end()) {
                    plain += vertices;
                    continue;
                }
                textured += vertices;
                AccessorReader accessors(*model, 100);
                const auto rows = accessors.rows(found->second, "TEXCOORD_0");
                ASSERT_TRUE(rows) << rows.error().message;
                ASSERT_EQ(rows->size(), vertices);
                EXPECT_EQ((*rows)[1][0], 4);
                EXPECT_EQ((*rows)[2][1], -2);
            }
        }
        const bool is_merged = profile == GlbProfile::kMerged;
        EXPECT_EQ(textured, is_merged ? 6U : 3U);
        EXPECT_EQ(plain, is_merged ? 9U : 6U);
    }
}

TEST(GlbReader, ReadsBackTheKitThatWasWritten) {
    const auto& castle = *examples::built_in().front();
    GlbOptions options;
    options.named_nodes = true;
    const auto glb = write_glb(discrete::make_piece_sheet(castle), options);
    ASSERT_TRUE(glb);
    const auto kit = read_glb(bytes_of(*glb));
    ASSERT_TRUE(kit) << kit.error().message;
    for (const discrete::Piece& piece : castle.pieces) {
        if (!piece.mesh) {
            continue;
        }
        const auto found =
            std::find_if(kit->meshes.begin(), kit->meshes.end(), [&](const Mesh& mesh) {
                return mesh.name == piece.name;
            });
        ASSERT_NE(found, kit->meshes.end()) << piece.name;
        const Mesh& original = castle.kit->meshes[*piece.mesh];
        ASSERT_EQ(found->primitives.size(), original.primitives.size());
        for (std::size_t i = 0; i < original.primitives.size(); ++i) {
            EXPECT_EQ(found->primitives[i].indices, original.primitives[i].indices);
            if (piece.quarter_turns == 0) {
                EXPECT_EQ(found->primitives[i].positions, original.primitives[i].positions);
            }
        }
    }
}

TEST(GlbReader, RefusesEveryTruncationAndEveryWrongHeaderByte) {
    const auto glb = write_glb(castle_scene());
    for (std::size_t length = 0; length < glb->size(); length += 1 + length / 7) {
        EXPECT_FALSE(read_glb(bytes_of(glb->substr(0, length)))) << length;
    }
    for (std::size_t at = 0; at < 20; ++at) {
        std::string changed = *glb;
        changed[at] = static_cast<char>(changed[at] ^ 0x55);
        EXPECT_FALSE(read_glb(bytes_of(changed))) << at;
    }
}

}  // namespace
}  // namespace modelsynth
