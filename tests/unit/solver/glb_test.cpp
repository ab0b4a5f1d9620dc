#include "solver/discrete/scene.h"
#include "solver/examples/built_in.h"
#include "solver/mesh/glb_reader.h"
#include "solver/mesh/glb_writer.h"

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
