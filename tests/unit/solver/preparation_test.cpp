#include "solver/discrete/preparation.h"

#include "solver/discrete/initial_model.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::RecordingObserver;

std::shared_ptr<const Example> castle() { return examples::built_in().front(); }

Parameters sized(const Example& example, const GridSize& size, Order order = Order::kScan) {
    Parameters parameters;
    parameters.size = size;
    parameters.order.order = order;
    return fill_defaults(parameters, example);
}

std::vector<Label> labels_of(Preparation& preparation, std::uint64_t seed) {
    RecordingObserver observer;
    return synthesise(preparation, seed, observer, {}).value().labels;
}

std::vector<Label> labels_alone(const Parameters& parameters, std::uint64_t seed) {
    RecordingObserver observer;
    return synthesise(*castle(), parameters, seed, observer, {}).value().labels;
}

TEST(Preparation, WhatARunLeavesChangesNoLaterResult) {
    for (const Order order : {Order::kMinEntropy, Order::kScan, Order::kRandom}) {
        const Parameters parameters = sized(*castle(), {24, 9, 18}, order);
        const auto preparation = Preparation::make(castle(), parameters).value();
        for (const std::uint64_t seed : {1U, 2U, 1U}) {
            EXPECT_EQ(labels_of(*preparation, seed), labels_alone(parameters, seed));
        }
    }
}

TEST(Preparation, AStoppedRunLeavesNothingBehind) {
    const Parameters parameters = sized(*castle(), {24, 9, 18});
    const auto preparation = Preparation::make(castle(), parameters).value();
    std::stop_source stop;
    stop.request_stop();
    RecordingObserver observer;
    EXPECT_EQ(
        synthesise(*preparation, 3, observer, stop.get_token()).error().code, ErrorCode::kCancelled
    );
    EXPECT_EQ(labels_of(*preparation, 3), labels_alone(parameters, 3));
}

TEST(Preparation, IsNotKeptWhenItWasStopped) {
    const Parameters parameters = sized(*castle(), {24, 9, 18});
    std::stop_source stop;
    stop.request_stop();
    PreparationCache cache;
    const auto stopped = cache.find_or_make(castle(), parameters, stop.get_token());
    ASSERT_FALSE(stopped.has_value());
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    const auto made = cache.find_or_make(castle(), parameters).value();
    EXPECT_EQ(labels_of(*made, 3), labels_alone(parameters, 3));
}

TEST(Preparation, ServesSeveralThreadsAtOnce) {
    const Parameters parameters = sized(*castle(), {24, 9, 18});
    const auto preparation = Preparation::make(castle(), parameters).value();
    std::vector<std::vector<Label>> made(4);
    {
        std::vector<std::jthread> threads;
        for (std::size_t seed = 0; seed < made.size(); ++seed) {
            threads.emplace_back([&, seed] { made[seed] = labels_of(*preparation, seed); });
        }
    }
    for (std::size_t seed = 0; seed < made.size(); ++seed) {
        EXPECT_EQ(made[seed], labels_alone(parameters, seed));
    }
}

// Two pieces that alternate along x and z, neither beside itself.
std::shared_ptr<const Example> chequers() {
    return std::make_shared<const Example>(testing::make_example({2, 1, 2}, {0, 1, 1, 0}, 2));
}

InitialModel initial_model(const std::shared_ptr<const Example>& example, const GridSize& size) {
    const auto preparation = Preparation::make(example, sized(*example, size)).value();
    const auto search = preparation->take_search();
    return find_initial_model(*preparation, *search, 1, {}).value();
}

TEST(InitialModel, OfAnExampleWithoutGroundIsSearchedOrWhenLargeATile) {
    const auto example = chequers();
    const InitialModel small = initial_model(example, {30, 1, 20});
    EXPECT_TRUE(small.is_searched);
    EXPECT_FALSE(testing::find_inconsistency(*example, {30, 1, 20}, *small.labels));
    const InitialModel large = initial_model(example, {400, 1, 401});
    EXPECT_FALSE(large.is_searched);
    EXPECT_FALSE(testing::find_inconsistency(*example, {400, 1, 401}, *large.labels));
}

// A floor of two pieces that alternate, air above: air everywhere is a model, and no block of it
// can become anything else, since beside air there is only air.
TEST(InitialModel, OfAirThatNoBlockCanChangeIsNotTaken) {
    auto example = std::make_shared<Example>(
        testing::make_example({2, 3, 2}, {0, 1, 1, 0, 2, 2, 2, 2, 2, 2, 2, 2}, 3)
    );
    example->empty = 2;
    // Of any size: a tile that repeats would be air as well.
    for (const GridSize& size : {GridSize{20, 3, 20}, GridSize{300, 3, 300}}) {
        const auto preparation = Preparation::make(example, sized(*example, size)).value();
        EXPECT_FALSE(preparation->plain_model());
        EXPECT_TRUE(preparation->is_plain_model_rigid());
        const std::vector<Label> labels = labels_of(*preparation, 4);
        EXPECT_FALSE(testing::find_inconsistency(*example, size, labels));
        EXPECT_GT(std::count(labels.begin(), labels.end(), Label{0}), 0);
    }
}

TEST(InitialModel, OfGroundIsPlainAndDependsOnNoSeed) {
    const auto preparation = Preparation::make(castle(), sized(*castle(), {12, 9, 12})).value();
    const auto search = preparation->take_search();
    ASSERT_TRUE(preparation->plain_model());
    for (const std::uint64_t seed : {1U, 2U}) {
        const auto found = find_initial_model(*preparation, *search, seed, {});
        EXPECT_FALSE(found->is_searched);
        EXPECT_EQ(*found->labels, *preparation->plain_model());
    }
}

TEST(ParallelSynthesis, IsTheSameOnAnyNumberOfThreadsToTheLastReport) {
    Parameters parameters = sized(*castle(), {43, 9, 38});
    (*parameters.blocks)->layout.passes = 2;
    const auto preparation = Preparation::make(castle(), parameters).value();
    RecordingObserver alone;
    const auto expected = synthesise(*preparation, 9, alone, {}).value();
    for (std::uint32_t threads = 2; threads <= 8; ++threads) {
        RecordingObserver observer;
        const auto made = synthesise(*preparation, 9, observer, {}, nullptr, threads).value();
        EXPECT_EQ(made.labels, expected.labels) << threads;
        EXPECT_EQ(made.stats.blocks, expected.stats.blocks) << threads;
        EXPECT_EQ(made.stats.changed, expected.stats.changed) << threads;
        EXPECT_EQ(observer.models, alone.models) << threads;
        ASSERT_EQ(observer.reports.size(), alone.reports.size());
        for (std::size_t i = 0; i < alone.reports.size(); ++i) {
            EXPECT_EQ(observer.reports[i].index, i);
            EXPECT_EQ(observer.reports[i].region, alone.reports[i].region);
            EXPECT_EQ(observer.reports[i].attempts, alone.reports[i].attempts);
            EXPECT_EQ(observer.reports[i].tally, alone.reports[i].tally);
        }
    }
}

TEST(ParallelSynthesis, GoesOnFromACheckpoint) {
    const Parameters parameters = sized(*castle(), {33, 9, 28});
    const auto preparation = Preparation::make(castle(), parameters).value();
    RecordingObserver alone;
    const auto expected = synthesise(*preparation, 5, alone, {}).value();
    for (std::size_t block = 0; block < alone.reports.size(); block += 7) {
        const Checkpoint checkpoint = {
            alone.reports[block].index + 1, alone.reports[block].tally, alone.models[block]};
        RecordingObserver rest;
        const auto made = synthesise(*preparation, 5, rest, {}, &checkpoint, 3).value();
        EXPECT_EQ(made.labels, expected.labels);
        EXPECT_EQ(made.stats.blocks, expected.stats.blocks);
        EXPECT_EQ(rest.reports.size(), alone.reports.size() - block - 1);
    }
}

// Across the seam, in space, with blocks of any overlap.
TEST(ParallelSynthesis, IsTheSameOnAClosedGridInSpace) {
    Example example = testing::make_pillars();
    example.boundary.fill({BoundaryKind::kPeriodic});
    example.boundary[static_cast<std::size_t>(Direction::kUp)] = {BoundaryKind::kFree};
    example.boundary[static_cast<std::size_t>(Direction::kDown)] = {BoundaryKind::kFree};
    for (const double overlap : {0.0, 0.3, 0.5, 0.8}) {
        Parameters parameters = sized(example, {17, 13, 14});
        parameters.blocks = Blocks{{{5, 4, 6}, overlap, 1}, 3};
        RecordingObserver alone;
        RecordingObserver together;
        const auto expected = synthesise(example, parameters, 3, alone, {}).value();
        const auto made = synthesise(example, parameters, 3, together, {}, nullptr, 4).value();
        EXPECT_EQ(made.labels, expected.labels) << overlap;
        EXPECT_EQ(together.models, alone.models) << overlap;
    }
}

TEST(ParallelSynthesis, EndsWhenItIsStopped) {
    class StoppingObserver final : public Observer {
      public:
        explicit StoppingObserver(std::stop_source& source) : source_(source) {}

        void on_start(std::uint32_t, std::span<const Label>) override {}

        void on_block(const BlockReport& report) override {
            reports_ = report.index + 1;
            if (report.index == 5) {
                source_.request_stop();
            }
        }

        std::uint32_t reports_ = 0;

      private:
        std::stop_source& source_;
    };

    const Parameters parameters = sized(*castle(), {60, 9, 60});
    const auto preparation = Preparation::make(castle(), parameters).value();
    std::stop_source stop;
    StoppingObserver observer(stop);
    const auto made = synthesise(*preparation, 2, observer, stop.get_token(), nullptr, 4);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::kCancelled);
    EXPECT_GE(observer.reports_, 6U);
}

TEST(PreparationCache, GivesAnEqualRequestWhatAnEarlierOnePrepared) {
    PreparationCache cache;
    const auto of = [&](const std::shared_ptr<const Example>& example, const GridSize& size) {
        return cache.find_or_make(example, sized(*example, size)).value();
    };
    const auto first = of(castle(), {10, 9, 10});
    EXPECT_EQ(of(castle(), {10, 9, 10}), first);
    EXPECT_NE(of(castle(), {10, 9, 11}), first);
    // A copy is another example: it may be changed or gone by the next request.
    EXPECT_NE(of(std::make_shared<const Example>(*castle()), {10, 9, 10}), first);
    Parameters forbidding = sized(*castle(), {10, 9, 10});
    forbidding.constraints.push_back(
        {Forbidden{}, {castle()->pieces[1].name}, {.box = Box{{0, 0, 0}, {1, 9, 1}}}}
    );
    EXPECT_NE(cache.find_or_make(castle(), forbidding).value(), first);
    EXPECT_EQ(of(castle(), {10, 9, 10}), first);
}

TEST(PreparationCache, ForgetsTheOnesThatWereNotAskedForLongest) {
    PreparationCache cache;
    const auto of = [&](std::int32_t width) {
        return cache.find_or_make(castle(), sized(*castle(), {width, 9, 6})).value();
    };
    const std::weak_ptr<Preparation> first = of(6);
    const std::weak_ptr<Preparation> second = of(7);
    for (std::int32_t width = 8; width < 14; ++width) {
        EXPECT_EQ(of(6), first.lock());
        static_cast<void>(of(width));
    }
    static_cast<void>(of(14));
    EXPECT_FALSE(first.expired());
    EXPECT_TRUE(second.expired());
}

TEST(PreparationCache, TellsWhyARequestCannotBePrepared) {
    PreparationCache cache;
    auto example = std::make_shared<Example>(testing::make_pillars());
    Parameters parameters = sized(*example, {6, 6, 6});
    parameters.constraints.push_back(
        {Forbidden{}, {"a", "b", "c", "d"}, {.box = Box{{2, 2, 2}, {3, 3, 3}}}}
    );
    const auto made = cache.find_or_make(example, parameters);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::kContradiction);
}

}  // namespace
}  // namespace modelsynth::discrete
