#include "solver/core/block_queue.h"

#include "solver/core/block_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Pairs pairs_of(const BlockDependencies& dependencies) {
    Pairs pairs;
    std::vector<std::uint32_t> waits(dependencies.waits_for.size());
    for (std::uint32_t block = 0; block < waits.size(); ++block) {
        for (std::uint32_t i = dependencies.first_dependent[block];
             i < dependencies.first_dependent[block + 1];
             ++i) {
            EXPECT_TRUE(pairs.insert({block, dependencies.dependents[i]}).second);
            ++waits[dependencies.dependents[i]];
        }
    }
    EXPECT_EQ(waits, dependencies.waits_for);
    return pairs;
}

// waits[a][b]: block a waits for b, or for one that does.
std::vector<std::vector<bool>> all_waits(const Pairs& pairs, std::uint32_t count) {
    std::vector<std::vector<std::uint32_t>> direct(count);
    for (const auto& [earlier, later] : pairs) {
        direct[later].push_back(earlier);
    }
    std::vector<std::vector<bool>> waits(count, std::vector<bool>(count));
    for (std::uint32_t block = 0; block < count; ++block) {
        for (const std::uint32_t earlier : direct[block]) {
            waits[block][earlier] = true;
            for (std::uint32_t i = 0; i < earlier; ++i) {
                waits[block][i] = waits[block][i] || waits[earlier][i];
            }
        }
    }
    return waits;
}

// Cells of the model that the block changes or reads.
std::set<std::size_t> touched(const GridSize& model, Periodic periodic, const Box& block) {
    std::set<std::size_t> cells;
    const auto add = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        const auto wrap = [](std::int32_t at, std::int32_t extent, bool is_periodic) {
            return is_periodic ? (at + extent) % extent : at;
        };
        const Cell cell = {
            wrap(x, model.x, periodic.x),
            wrap(y, model.y, periodic.y),
            wrap(z, model.z, periodic.z)};
        if (model.contains(cell)) {
            cells.insert(model.index(cell));
        }
    };
    for_each_cell(block, [&](const Cell& cell) {
        add(cell.x, cell.y, cell.z);
        for (const Cell& step : kDirectionSteps) {
            add(cell.x + step.x, cell.y + step.y, cell.z + step.z);
        }
    });
    return cells;
}

TEST(BlockDependencies, HoldEveryPairOfWhichOneReadsOrChangesWhatTheOtherChanges) {
    const std::vector<GridSize> models = {{13, 3, 17}, {20, 9, 8}, {6, 6, 6}, {9, 1, 30}};
    for (const GridSize& model : models) {
        for (const Periodic periodic :
             {Periodic{}, Periodic{true, false, true}, {true, true, true}}) {
            for (const double overlap : {0.0, 0.4, 0.7}) {
                const auto blocks =
                    schedule_blocks(model, {{5, 3, 4}, overlap, 3}, 100'000).value();
                const auto first = static_cast<std::uint32_t>(blocks.size() / 3);
                const Pairs pairs = pairs_of(find_dependencies(model, periodic, blocks, first));
                std::vector<std::set<std::size_t>> changed;
                std::vector<std::set<std::size_t>> read;
                for (const Box& block : blocks) {
                    read.push_back(touched(model, periodic, block));
                    changed.emplace_back();
                    for_each_cell(block, [&](const Cell& cell) {
                        changed.back().insert(model.index(cell));
                    });
                }
                for (const auto& [earlier, later] : pairs) {
                    EXPECT_GE(earlier, first);
                    EXPECT_LT(earlier, later);
                }
                const auto waits = all_waits(pairs, static_cast<std::uint32_t>(blocks.size()));
                for (std::uint32_t later = first; later < blocks.size(); ++later) {
                    for (std::uint32_t earlier = first; earlier < later; ++earlier) {
                        const bool must = std::any_of(
                            changed[earlier].begin(),
                            changed[earlier].end(),
                            [&](std::size_t cell) { return read[later].contains(cell); }
                        );
                        ASSERT_TRUE(!must || waits[later][earlier]) << earlier << ' ' << later;
                    }
                }
            }
        }
    }
}

TEST(BlockDependencies, LeaveDistantBlocksFree) {
    const auto blocks = schedule_blocks({100, 10, 100}, {}, 1000).value();
    const BlockDependencies dependencies = find_dependencies({100, 10, 100}, {}, blocks, 0);
    // Two rows before and two places in its own row, of five by five around a block.
    EXPECT_EQ(*std::max_element(dependencies.waits_for.begin(), dependencies.waits_for.end()), 12U);
}

// Blocks 0 and 1 are free, 2 waits for 1, 3 for 0 and 2.
BlockDependencies four_blocks() { return {{0, 0, 1, 2}, {0, 1, 2, 3, 3}, {3, 2, 3}}; }

TEST(BlockQueue, HandsBlocksOutWhenTheyMayStartAndReportsThemInOrder) {
    using Kind = BlockQueue::Step::Kind;
    const BlockDependencies dependencies = four_blocks();
    BlockQueue queue(dependencies, 0, 10);
    EXPECT_EQ(queue.take(), 0U);
    EXPECT_EQ(queue.take(), 1U);
    queue.finish(1);
    EXPECT_EQ(queue.take(), 2U);
    queue.finish(2);
    queue.finish(0);
    for (std::uint32_t block = 0; block < 3; ++block) {
        const auto step = queue.next_step();
        EXPECT_EQ(step.kind, Kind::kReport);
        EXPECT_EQ(step.block, block);
    }
    const auto last = queue.next_step();
    EXPECT_EQ(last.kind, Kind::kSolve);
    EXPECT_EQ(last.block, 3U);
    EXPECT_EQ(queue.take(), std::nullopt);
    queue.finish(3);
    EXPECT_EQ(queue.next_step().kind, Kind::kReport);
    EXPECT_EQ(queue.next_step().kind, Kind::kEnd);
}

TEST(BlockQueue, RunsAheadOfTheReportsNoFurtherThanAllowed) {
    const BlockDependencies dependencies = {{0, 0, 0}, {0, 0, 0, 0}, {}};
    BlockQueue queue(dependencies, 0, 2);
    EXPECT_EQ(queue.take(), 0U);
    EXPECT_EQ(queue.take(), 1U);
    queue.finish(1);
    queue.finish(0);
    EXPECT_EQ(queue.next_step().kind, BlockQueue::Step::Kind::kReport);
    EXPECT_EQ(queue.take(), 2U);
}

TEST(BlockQueue, GoesOnAfterTheBlocksThatAreDone) {
    const auto blocks = schedule_blocks({40, 10, 10}, {}, 100).value();
    const BlockDependencies dependencies = find_dependencies({40, 10, 10}, {}, blocks, 3);
    BlockQueue queue(dependencies, 3, 10);
    for (std::uint32_t block = 3; block < blocks.size(); ++block) {
        EXPECT_EQ(queue.take(), block);
        queue.finish(block);
    }
    EXPECT_EQ(queue.take(), std::nullopt);
    EXPECT_EQ(queue.next_step().block, 3U);
}

TEST(BlockQueue, HandsNothingOutOnceStopped) {
    const BlockDependencies dependencies = four_blocks();
    BlockQueue queue(dependencies, 0, 10);
    queue.stop();
    EXPECT_EQ(queue.take(), std::nullopt);
    EXPECT_EQ(queue.next_step().kind, BlockQueue::Step::Kind::kEnd);
}

}  // namespace
}  // namespace modelsynth
