// Where a region is.

#include "solver/continuous/constraints/coverage.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace modelsynth::continuous {
namespace {

TEST(Coverage, OfABoxHasItsBorderAndEndsAtTheGround) {
    Region region;
    region.box = MetreBox{{1, -2, 3}, {4, 2, 5}};
    const Coverage coverage(region, {10, 8, 10});
    EXPECT_EQ(coverage.at({1, 0, 3}), 1);
    EXPECT_EQ(coverage.at({4, 2, 5}), 1);
    EXPECT_EQ(coverage.at({2, 1, 4}), 1);
    EXPECT_EQ(coverage.at({0.999, 1, 4}), 0);
    EXPECT_EQ(coverage.at({2, 2.001, 4}), 0);
    EXPECT_EQ(coverage.at({2, 1, 5.001}), 0);
    EXPECT_EQ(coverage.at({2, -0.001, 4}), 0);
    EXPECT_TRUE(coverage.is_uniform({2.5, 1, 4}, 0.9));
    EXPECT_FALSE(coverage.is_uniform({2.5, 1, 4}, 1.1));
    EXPECT_FALSE(coverage.is_uniform({2.5, 0.1, 4}, 0.2));
}

TEST(Coverage, OfNothingIsEverywhereAboveTheGround) {
    const Region region;
    const Coverage coverage(region, {10, 8, 10});
    EXPECT_EQ(coverage.at({5, 0, 5}), 1);
    EXPECT_EQ(coverage.at({5, 8, 5}), 1);
    EXPECT_EQ(coverage.at({5, -0.1, 5}), 0);
}

TEST(Coverage, OfMasksAndVoxelsIsThatOfTheirCells) {
    Region mask;
    mask.mask = Mask{2, 3, {0, 51, 102, 153, 204, 255}, ""};
    const Coverage by_mask(mask, {10, 8, 9});
    EXPECT_DOUBLE_EQ(by_mask.at({4.99, 7, 2.99}), 0);
    EXPECT_DOUBLE_EQ(by_mask.at({5, 0, 0}), 0.2);
    EXPECT_DOUBLE_EQ(by_mask.at({4.99, 3, 3}), 0.4);
    EXPECT_DOUBLE_EQ(by_mask.at({10, 8, 9}), 1);
    EXPECT_DOUBLE_EQ(by_mask.at({10, -0.1, 9}), 0);

    Region voxels;
    voxels.voxels = Voxels{{2, 2, 1}, {0.1, 0.2, 0.3, 0.4}};
    const Coverage by_voxels(voxels, {10, 8, 9});
    EXPECT_EQ(by_voxels.at({1, 3.99, 5}), 0.1);
    EXPECT_EQ(by_voxels.at({6, 3.99, 5}), 0.2);
    EXPECT_EQ(by_voxels.at({1, 4, 5}), 0.3);
    EXPECT_EQ(by_voxels.at({10, 8, 9}), 0.4);

    // Of several the most.
    Region both = mask;
    both.voxels = voxels.voxels;
    both.box = MetreBox{{0, 0, 0}, {1, 1, 1}};
    const Coverage most(both, {10, 8, 9});
    EXPECT_EQ(most.at({0.5, 0.5, 0.5}), 1);
    EXPECT_EQ(most.at({2, 2, 2}), 0.1);
    EXPECT_DOUBLE_EQ(most.at({6, 2, 4}), 0.6);
}

TEST(Coverage, IsNeverCalledUniformWhereItIsNot) {
    std::mt19937_64 random(7);
    const auto share = [&] { return static_cast<double>(random() % 1'000'003) / 1'000'003; };
    const std::array<double, 3> size = {7, 5, 6};
    std::size_t uniform = 0;
    std::size_t various = 0;
    for (int round = 0; round < 300; ++round) {
        Region region;
        const auto kinds = random() % 8;
        if ((kinds & 1) != 0) {
            MetreBox& box = region.box.emplace();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.min[axis] = share() * size[axis] - 1;
                box.max[axis] = box.min[axis] + 0.1 + 4 * share();
            }
        }
        if ((kinds & 2) != 0) {
            region.mask = Mask{3, 2, {}, ""};
            for (int i = 0; i < 6; ++i) {
                region.mask->values.push_back(static_cast<std::uint8_t>(random() % 2 * 255));
            }
        }
        if ((kinds & 4) != 0) {
            region.voxels = Voxels{{3, 2, 2}, {}};
            for (int i = 0; i < 12; ++i) {
                region.voxels->values.push_back(random() % 3 == 0 ? 1 : 0);
            }
        }
        const Coverage coverage(region, size);
        for (int i = 0; i < 30; ++i) {
            const Point place(9 * share() - 1, 7 * share() - 1, 8 * share() - 1);
            const double reach = share();
            const double there = coverage.at(place);
            bool is_same = true;
            for (int look = 0; look < 60; ++look) {
                const Point way(2 * share() - 1, 2 * share() - 1, 2 * share() - 1);
                is_same = is_same && coverage.at(place + reach * way) == there;
            }
            const bool is_uniform = coverage.is_uniform(place, reach);
            EXPECT_TRUE(is_same || !is_uniform) << place.transpose() << " within " << reach;
            ++(is_uniform ? uniform : various);
        }
    }
    EXPECT_GT(uniform, 1000U);
    EXPECT_GT(various, 1000U);
}

}  // namespace
}  // namespace modelsynth::continuous
