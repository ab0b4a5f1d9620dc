#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <string>

namespace modelsynth::discrete {
namespace {

using testing::find_inconsistency;
using testing::RecordingObserver;

// What a user may ask of a built-in example without having read how it was made.
class BuiltIn : public ::testing::TestWithParam<std::size_t> {
  protected:
    [[nodiscard]] static const Example& example() { return *examples::built_in()[GetParam()]; }

    static void expect_model(Parameters parameters, std::uint64_t seed) {
        const GridSize size = *parameters.size;
        const std::string what = example().name + " " + std::to_string(size.x) + " x " +
                                 std::to_string(size.y) + " x " + std::to_string(size.z) +
                                 " seed " + std::to_string(seed);
        parameters = fill_defaults(parameters, example());
        RecordingObserver observer;
        const auto model = synthesise(example(), parameters, seed, observer, {});
        ASSERT_TRUE(model) << what << ": " << model.error().message;
        EXPECT_EQ(find_inconsistency(example(), size, model->labels), std::nullopt) << what;
    }
};

TEST_P(BuiltIn, IsMadeInEverySizeFromFourCellsOn) {
    std::uint64_t seed = 0;
    for (std::int32_t x = 4; x <= 13; ++x) {
        for (std::int32_t z = 4; z <= 13; ++z) {
            Parameters parameters;
            parameters.size = GridSize{x, 4 + static_cast<std::int32_t>(seed % 7), z};
            expect_model(parameters, ++seed);
        }
    }
}

TEST_P(BuiltIn, IsMadeInEveryOrderAndInBlocksOfAnySize) {
    for (const Order order : {Order::kScan, Order::kMinEntropy, Order::kRandom}) {
        for (const std::int32_t extent : {4, 7, 16}) {
            Parameters parameters;
            parameters.size = GridSize{23, 8, 17};
            parameters.order.order = order;
            Blocks blocks;
            blocks.layout.size = {extent, 8, extent};
            parameters.blocks = blocks;
            expect_model(parameters, static_cast<std::uint64_t>(extent));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    BuiltIn,
    ::testing::Range<std::size_t>(0, 3),
    [](const auto& tested) { return examples::built_in()[tested.param]->name; }
);

}  // namespace
}  // namespace modelsynth::discrete
