#include "solver/core/block_queue.h"

#include "solver/core/block_schedule.h"
#include "solver/core/box_index.h"
#include "solver/core/parallel_blocks.h"
#include "solver/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace modelsynth {
namespace {

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

bool meets(const std::set<std::size_t>& a, const std::set<std::size_t>& b) {
    return std::any_of(a.begin(), a.end(), [&](std::size_t cell) { return b.contains(cell); });
}

TEST(BlockQueue, HandsABlockOutOnlyWhenNoEarlierOneThatItReadsIsUnfinished) {
    const std::vector<GridSize> models = {{13, 3, 17}, {20, 9, 8}, {6, 6, 6}, {9, 1, 30}};
    for (const GridSize& model : models) {
        for (const Periodic periodic :
             {Periodic{}, Periodic{true, false, true}, {true, true, true}}) {
            const auto blocks = schedule_blocks(model, {{5, 3, 4}, 0.4, 3}, 100'000).value();
            const auto first = static_cast<std::uint32_t>(blocks.size() / 3);
            std::vector<std::set<std::size_t>> changed;
            std::vector<std::set<std::size_t>> read;
            for (const Box& block : blocks) {
                read.push_back(touched(model, periodic, block));
                changed.emplace_back();
                for_each_cell(block, [&](const Cell& cell) {
                    changed.back().insert(model.index(cell));
                });
            }
            BlockQueue queue(model, periodic, blocks, first, 40);
            std::mutex mutex;
            std::vector<bool> finished(blocks.size());
            const auto is_free = [&](std::uint32_t block) {
                const std::lock_guard lock(mutex);
                for (std::uint32_t earlier = first; earlier < block; ++earlier) {
                    if (!finished[earlier] && meets(changed[earlier], read[block])) {
                        return false;
                    }
                }
                return true;
            };
            const auto solve = [&](std::uint32_t block) {
                EXPECT_TRUE(is_free(block)) << block;
                {
                    const std::lock_guard lock(mutex);
                    finished[block] = true;
                }
                queue.finish(block);
            };
            std::uint32_t reported = first;
            {
                std::vector<std::jthread> helpers;
                for (int i = 0; i < 3; ++i) {
                    helpers.emplace_back([&] {
                        while (const auto block = queue.take()) {
                            solve(*block);
                        }
                    });
                }
                for (auto step = queue.next_step(); step.kind != BlockQueue::Step::Kind::kEnd;
                     step = queue.next_step()) {
                    if (step.kind == BlockQueue::Step::Kind::kSolve) {
                        solve(step.block);
                    } else {
                        EXPECT_EQ(step.block, reported++);
                        const std::lock_guard lock(mutex);
                        EXPECT_TRUE(finished[step.block]);
                    }
                }
            }
            EXPECT_EQ(reported, blocks.size());
        }
    }
}

TEST(BlocksMeet, WhenTheyOverlapOrTouchAlsoAcrossASeam) {
    const GridSize model = {12, 4, 12};
    const Box west = {{0, 0, 0}, {4, 4, 4}};
    const Box next = {{4, 0, 0}, {8, 4, 4}};
    const Box east = {{8, 0, 0}, {12, 4, 4}};
    const Box apart = {{5, 0, 5}, {8, 4, 9}};
    EXPECT_TRUE(blocks_meet(west, next, model, {}));
    EXPECT_FALSE(blocks_meet(west, east, model, {}));
    EXPECT_TRUE(blocks_meet(west, east, model, {true, false, false}));
    EXPECT_FALSE(blocks_meet(west, apart, model, {}));
}

TEST(BoxIndex, FindsEveryBoxThatMeetsOneAndEachOnce) {
    const GridSize model = {23, 5, 31};
    RandomStream random({7, 0, 0, 0});
    for (int round = 0; round < 200; ++round) {
        // Of small boxes there are many places, of large ones only one along an axis.
        const std::uint32_t longest = 1 + random.below(round % 10 == 0 ? 5 : 3);
        std::vector<Box> boxes;
        for (int i = 0; i < 40; ++i) {
            const auto span = [&](std::int32_t extent) {
                const auto length = static_cast<std::int32_t>(1 + random.below(longest));
                const auto start = static_cast<std::int32_t>(
                    random.below(static_cast<std::uint32_t>(extent - length + 1))
                );
                return std::pair(start, start + length);
            };
            const auto [west, east] = span(model.x);
            const auto [bottom, top] = span(model.y);
            const auto [north, south] = span(model.z);
            boxes.push_back({{west, bottom, north}, {east, top, south}});
        }
        BoxIndex index(model, boxes);
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            index.add(i, boxes[i]);
        }
        for (std::uint32_t i = 0; i < boxes.size(); i += 3) {
            index.remove(i, boxes[i]);
        }
        for (const Box& box : boxes) {
            std::multiset<std::uint32_t> near;
            index.for_each_near(box, [&near](std::uint32_t number) { near.insert(number); });
            for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                ASSERT_LE(near.count(i), i % 3 == 0 ? 0U : 1U);
                if (i % 3 != 0 && blocks_meet(boxes[i], box, model, {true, true, true})) {
                    ASSERT_EQ(near.count(i), 1U);
                }
            }
        }
    }
}

// A row of blocks side by side: each waits for the one before it.
std::vector<Box> row(std::int32_t count, std::int32_t gap) {
    std::vector<Box> blocks;
    for (std::int32_t i = 0; i < count; ++i) {
        blocks.push_back({{i * (1 + gap), 0, 0}, {i * (1 + gap) + 1, 1, 1}});
    }
    return blocks;
}

constexpr GridSize kRowSize = {100, 1, 1};

TEST(BlockQueue, HandsBlocksOutWhenTheyMayStartAndReportsThemInOrder) {
    using Kind = BlockQueue::Step::Kind;
    // Blocks 0 and 1 are free, 2 meets 1, 3 meets 0 and 2.
    const std::vector<Box> blocks = {
        {{0, 0, 0}, {4, 1, 1}},
        {{20, 0, 0}, {24, 1, 1}},
        {{24, 0, 0}, {30, 1, 1}},
        {{4, 0, 0}, {27, 1, 1}}};
    BlockQueue queue(kRowSize, {}, blocks, 0, 10);
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
    const std::vector<Box> blocks = row(3, 2);
    BlockQueue queue(kRowSize, {}, blocks, 0, 2);
    EXPECT_EQ(queue.take(), 0U);
    EXPECT_EQ(queue.take(), 1U);
    queue.finish(1);
    queue.finish(0);
    EXPECT_EQ(queue.next_step().kind, BlockQueue::Step::Kind::kReport);
    EXPECT_EQ(queue.take(), 2U);
}

// What a block came to may be large, and many blocks come.
TEST(ParallelBlocks, ForgetWhatABlockCameToOnceItIsReported) {
    constexpr std::uint32_t kBlocks = 40;
    using Solved = std::shared_ptr<const std::uint32_t>;
    const std::vector<Box> blocks = row(kBlocks, 1);
    const auto solve = [](std::uint32_t block) -> std::optional<Solved> {
        return std::make_shared<const std::uint32_t>(block);
    };
    std::vector<std::weak_ptr<const std::uint32_t>> reported;
    const bool is_done = ParallelBlocks<Solved>(kRowSize, {}, blocks, 0)
                             .run(
                                 3,
                                 solve,
                                 [&] { return solve; },
                                 [&](std::uint32_t block, const Solved& solved) {
                                     EXPECT_EQ(block, reported.size());
                                     EXPECT_EQ(*solved, block);
                                     EXPECT_TRUE(reported.empty() || reported.back().expired());
                                     reported.emplace_back(solved);
                                 }
                             );
    EXPECT_TRUE(is_done);
    EXPECT_EQ(reported.size(), kBlocks);
}

TEST(BlockQueue, GoesOnAfterTheBlocksThatAreDone) {
    const std::vector<Box> blocks = row(9, 0);
    BlockQueue queue(kRowSize, {}, blocks, 3, 10);
    for (std::uint32_t block = 3; block < blocks.size(); ++block) {
        EXPECT_EQ(queue.take(), block);
        queue.finish(block);
    }
    EXPECT_EQ(queue.take(), std::nullopt);
    EXPECT_EQ(queue.next_step().block, 3U);
}

TEST(BlockQueue, HandsNothingOutOnceStopped) {
    const std::vector<Box> blocks = row(4, 2);
    BlockQueue queue(kRowSize, {}, blocks, 0, 10);
    queue.stop();
    EXPECT_EQ(queue.take(), std::nullopt);
    EXPECT_EQ(queue.next_step().kind, BlockQueue::Step::Kind::kEnd);
}

}  // namespace
}  // namespace modelsynth
