#include "clients/cli/output_file.h"

#include <gtest/gtest.h>

namespace modelsynth::cli {
namespace {

TEST(NumberedFile, ThePlaceIsBeforeTheExtension) {
    EXPECT_EQ(numbered_file("castle.glb", 0), "castle.glb");
    EXPECT_EQ(numbered_file("castle.glb", 1), "castle-1.glb");
    EXPECT_EQ(numbered_file("a.b/castle.v2.glb", 12), "a.b/castle.v2-12.glb");
    EXPECT_EQ(numbered_file("a.b/castle", 2), "a.b/castle-2");
    EXPECT_EQ(numbered_file("castle", 2), "castle-2");
    EXPECT_EQ(numbered_file(".glb", 2), ".glb-2");
    EXPECT_EQ(numbered_file("a/.glb", 2), "a/.glb-2");
}

}  // namespace
}  // namespace modelsynth::cli
