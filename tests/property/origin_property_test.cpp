// Models that start from finished ones, over random examples.

#include "solver/core/random.h"
#include "solver/discrete/origin.h"
#include "solver/discrete/preparation.h"
#include "solver/discrete/region.h"
#include "solver/discrete/synthesis.h"
#include "tests/support/case_count.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace modelsynth::discrete {
namespace {

using testing::find_inconsistency;
using testing::make_random_example;
using testing::RecordingObserver;

Parameters sized(const Example& example, const GridSize& size, bool in_blocks) {
    Parameters parameters;
    parameters.size = size;
    Blocks blocks;
    blocks.layout.size = {4, 3, 4};
    parameters.blocks = in_blocks ? std::optional(blocks) : std::nullopt;
    return fill_defaults(parameters, example);
}

TEST(OriginProperty, WhatIsKeptKeepsItsLabelsInEveryStateAndTheRestFitsToIt) {
    std::size_t remade = 0;
    std::size_t grown = 0;
    std::size_t cases = 0;
    std::size_t failed = 0;
    for (std::uint64_t seed = 0; seed < testing::case_count(400); ++seed) {
        RandomStream random({seed, 3, 0, 98});
        const auto below = [&random](std::int32_t bound) {
            return static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(bound)));
        };
        const Example example = make_random_example(seed);
        const GridSize small = {2 + below(6), 1 + below(3), 2 + below(6)};
        RecordingObserver first;
        const auto older = synthesise(example, sized(example, small, true), seed, first, {});
        if (!older) {
            continue;
        }
        Origin origin = {small, older->labels};
        GridSize size = small;
        if (below(2) == 0) {
            const Cell more = {below(4), below(2), below(4)};
            size = {small.x + more.x, small.y + more.y, small.z + more.z};
            origin.at = {below(more.x + 1), below(more.y + 1), below(more.z + 1)};
        }
        if (below(3) > 0) {
            const Cell min = {below(size.x), below(size.y), below(size.z)};
            origin.remade.box =
                Box{min,
                    {min.x + 1 + below(size.x - min.x),
                     min.y + 1 + below(size.y - min.y),
                     min.z + 1 + below(size.z - min.z)}};
        }
        const std::string where = "seed " + std::to_string(seed);
        const std::shared_ptr<const Example> not_owned(std::shared_ptr<const Example>(), &example);
        const auto preparation =
            Preparation::make(not_owned, sized(example, size, below(3) > 0), &origin);
        ASSERT_TRUE(preparation) << where << ": " << preparation.error().message;
        RecordingObserver observer;
        const auto made = synthesise(**preparation, seed + 1, observer, {});
        ++cases;
        if (!made) {
            ++failed;  // what lies beyond the older model may have no labels that fit to it
            ASSERT_NE(size, small) << where << ": " << made.error().message;
            continue;
        }
        const auto check = [&](std::span<const Label> model) {
            ASSERT_EQ(find_inconsistency(example, size, model), std::nullopt) << where;
            const RegionCoverage region(origin.remade, size);
            std::size_t next = 0;
            const bool keeps_all = region.is_everywhere() && size != small;
            const Box covered = {
                origin.at, {origin.at.x + small.x, origin.at.y + small.y, origin.at.z + small.z}};
            for_each_cell(covered, [&](const Cell& cell) {
                const Label label = older->labels[next++];
                if (keeps_all || !region.contains(cell)) {
                    ASSERT_EQ(model[size.index(cell)], label) << where;
                }
            });
        };
        if (!observer.initial_model.empty()) {
            check(observer.initial_model);
        }
        for (const auto& model : observer.models) {
            check(model);
        }
        check(made->labels);
        std::size_t changed = 0;
        for (std::size_t site = 0; size == small && site < made->labels.size(); ++site) {
            changed += made->labels[site] != older->labels[site] ? 1U : 0U;
        }
        if (size == small) {
            EXPECT_DOUBLE_EQ(
                made->stats.changed,
                static_cast<double>(changed) / static_cast<double>(made->labels.size())
            ) << where;
            remade += changed > 0 ? 1U : 0U;
        } else {
            ++grown;
        }
        if (HasFatalFailure()) {
            return;
        }
    }
    if (testing::are_cases_usual(400)) {
        EXPECT_GT(remade, cases / 8);
        EXPECT_GT(grown, cases / 8);
        EXPECT_LT(failed, cases / 3);
    }
}

}  // namespace
}  // namespace modelsynth::discrete
