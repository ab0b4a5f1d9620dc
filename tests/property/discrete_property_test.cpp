#include "solver/core/random.h"
#include "solver/discrete/faults.h"
#include "solver/discrete/problem.h"
#include "solver/discrete/synthesis.h"
#include "tests/support/case_count.h"
#include "tests/support/chi_squared.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <set>
#include <string>

namespace modelsynth::discrete {
namespace {

using testing::find_inconsistency;
using testing::make_random_example;
using testing::RecordingObserver;

struct Case {
    Example example;
    Parameters parameters;
    std::array<bool, 3> periodic = {false, false, false};
};

Case make_case(std::uint64_t seed) {
    Case made = {make_random_example(seed), {}, {}};
    RandomStream random({seed, 1, 0, 99});
    const auto below = [&random](std::uint32_t bound) {
        return static_cast<std::int32_t>(random.below(bound));
    };
    Parameters& parameters = made.parameters;
    parameters.size = GridSize{1 + below(12), 1 + below(5), 1 + below(12)};
    if (below(4) == 0) {
        parameters.blocks = std::optional<Blocks>();
    } else {
        Blocks blocks;
        blocks.layout.size = {2 + below(7), 1 + below(5), 2 + below(7)};
        blocks.layout.overlap = 0.1 * below(9);
        blocks.layout.passes = static_cast<std::uint32_t>(1 + below(2));
        parameters.blocks = blocks;
    }
    constexpr std::array<Order, 5> kOrders = {
        Order::kScan, Order::kMinEntropy, Order::kFewestLabels, Order::kRandom, Order::kGrowth};
    parameters.order.order = kOrders.at(random.below(5));
    parameters.weights = below(2) == 0 ? WeightRule::kUniform : WeightRule::kExample;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto kind = random.below(5);
        for (const std::size_t side : {2 * axis, 2 * axis + 1}) {
            SideBoundary boundary;
            if (kind == 0) {
                boundary.kind = BoundaryKind::kPeriodic;
                made.periodic[axis] = true;
            } else if (kind == 1) {
                boundary.kind = BoundaryKind::kExample;
            } else if (kind == 2) {
                boundary = {BoundaryKind::kPieces, {"a"}};
            }
            parameters.boundary[side] = boundary;
        }
    }
    if (below(3) == 0) {
        const Label cell =
            made.example.cells[random.below(static_cast<std::uint32_t>(made.example.cells.size()))];
        parameters.constraints.push_back(
            {Fixed{},
             {made.example.pieces[cell].name},
             {.cells =
                  {{below(static_cast<std::uint32_t>(parameters.size->x)),
                    below(static_cast<std::uint32_t>(parameters.size->y)),
                    below(static_cast<std::uint32_t>(parameters.size->z))}}}}
        );
    }
    parameters = fill_defaults(parameters, made.example);
    return made;
}

// The boundary and the fixed cells, checked from the request alone.
void expect_wishes_held(const Case& wanted, const Synthesis& model, std::uint64_t seed) {
    const GridSize size = model.size;
    const Example& example = wanted.example;
    const auto side_of = [&size](std::size_t side, const Cell& cell) {
        switch (static_cast<Direction>(side)) {
            case Direction::kEast:
                return cell.x == size.x - 1;
            case Direction::kWest:
                return cell.x == 0;
            case Direction::kUp:
                return cell.y == size.y - 1;
            case Direction::kDown:
                return cell.y == 0;
            case Direction::kSouth:
                return cell.z == size.z - 1;
            case Direction::kNorth:
                return cell.z == 0;
        }
        return false;
    };
    for_each_cell(Box::whole(size), [&](const Cell& cell) {
        const Label label = model.labels[size.index(cell)];
        for (std::size_t side = 0; side < kDirectionCount; ++side) {
            const SideBoundary& boundary = *wanted.parameters.boundary[side];
            if (side_of(side, cell) && boundary.kind == BoundaryKind::kPieces) {
                ASSERT_EQ(example.pieces[label].name, "a") << "seed " << seed;
            }
        }
    });
    for (const Constraint& constraint : wanted.parameters.constraints) {
        const Label label = model.labels[size.index(constraint.region.cells[0])];
        ASSERT_EQ(example.pieces[label].name, constraint.pieces[0]) << "seed " << seed;
    }
}

TEST(DiscreteProperty, EveryModelOfARandomRequestIsConsistent) {
    std::size_t solved = 0;
    std::size_t refused = 0;
    for (std::uint64_t seed = 0; seed < testing::case_count(600); ++seed) {
        const Case wanted = make_case(seed);
        ASSERT_TRUE(find_faults(wanted.example, wanted.parameters).empty()) << "seed " << seed;
        RecordingObserver observer;
        const auto model = synthesise(wanted.example, wanted.parameters, seed, observer, {});
        if (!model) {
            ++refused;
            ASSERT_TRUE(
                model.error().code == ErrorCode::kContradiction ||
                model.error().code == ErrorCode::kGaveUp
            ) << "seed "
              << seed;
            ASSERT_FALSE(model.error().message.empty());
            continue;
        }
        ++solved;
        ASSERT_EQ(
            find_inconsistency(wanted.example, model->size, model->labels, wanted.periodic),
            std::nullopt
        ) << "seed "
          << seed;
        expect_wishes_held(wanted, *model, seed);
        if (HasFatalFailure()) {
            return;
        }
    }
    // The cases must reach both ends, or they test nothing.
    if (testing::are_cases_usual(600)) {
        EXPECT_GT(solved, testing::case_count(600) / 4);
        EXPECT_GT(refused, testing::case_count(600) / 50);
    }
}

TEST(DiscreteProperty, EqualRequestsGiveEqualModelsAndOtherSeedsOthers) {
    std::size_t different = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const Case wanted = make_case(seed);
        RecordingObserver first;
        RecordingObserver second;
        RecordingObserver other;
        const auto a = synthesise(wanted.example, wanted.parameters, seed, first, {});
        const auto b = synthesise(wanted.example, wanted.parameters, seed, second, {});
        const auto c = synthesise(wanted.example, wanted.parameters, seed + 1000, other, {});
        ASSERT_EQ(a.has_value(), b.has_value());
        ASSERT_EQ(first.models, second.models) << "seed " << seed;
        if (a && c) {
            ASSERT_EQ(a->labels, b->labels);
            different += a->labels != c->labels ? 1U : 0U;
        }
    }
    EXPECT_GT(different, 10U);
}

// Where any pieces may be neighbours every cell is a draw by the weights, whatever comes first.
TEST(DiscreteProperty, LabelsAreChosenByTheirWeightsInEveryOrder) {
    constexpr std::array<double, 6> kWeights = {1, 2, 0, 3, 5, 9};
    Example example = testing::make_example({0, 0, 0}, {}, kWeights.size());
    WeightList named;
    for (Label a = 0; a < kWeights.size(); ++a) {
        named.emplace_back(example.pieces[a].name, kWeights.at(a));
        for (Label b = 0; b < kWeights.size(); ++b) {
            example.adjacency.push_back({0, a, b});
            example.adjacency.push_back({2, a, b});
        }
    }
    for (const Order order :
         {Order::kScan, Order::kMinEntropy, Order::kFewestLabels, Order::kRandom, Order::kGrowth}) {
        for (const bool in_blocks : {true, false}) {
            Parameters parameters;
            parameters.size = GridSize{60, 1, 70};
            parameters.order.order = order;
            parameters.weights = named;
            if (!in_blocks) {
                parameters.blocks.emplace(std::nullopt);
            }
            std::array<std::uint64_t, kWeights.size()> counts = {};
            for (std::uint64_t seed = 0; seed < 5; ++seed) {
                RecordingObserver observer;
                const auto model =
                    synthesise(example, fill_defaults(parameters, example), seed, observer, {});
                ASSERT_TRUE(model) << model.error().message;
                for (const Label label : model->labels) {
                    ++counts.at(label);
                }
            }
            EXPECT_LT(testing::chi_squared_deviation(counts, kWeights), 3.7)
                << static_cast<int>(order) << in_blocks;
        }
    }
}

// All models of a tiny size, by brute force; the solver must find one exactly when there is one.
TEST(DiscreteProperty, FindsATinyModelExactlyWhenThereIsOne) {
    std::size_t possible_cases = 0;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        const Example example = make_random_example(seed);
        const GridSize size = {2, 1, 3};
        const std::size_t labels = example.pieces.size();
        std::size_t combinations = 1;
        for (std::size_t i = 0; i < size.cell_count(); ++i) {
            combinations *= labels;
        }
        std::set<Label> used(example.cells.begin(), example.cells.end());
        bool possible = false;
        for (std::size_t code = 0; code < combinations && !possible; ++code) {
            std::vector<Label> cells;
            std::size_t rest = code;
            bool all_used = true;
            for (std::size_t i = 0; i < size.cell_count(); ++i) {
                cells.push_back(static_cast<Label>(rest % labels));
                all_used = all_used && used.contains(cells.back());
                rest /= labels;
            }
            possible = all_used && !find_inconsistency(example, size, cells);
        }
        Parameters parameters;
        parameters.size = size;
        parameters.blocks = std::optional<Blocks>();
        RecordingObserver observer;
        const auto model =
            synthesise(example, fill_defaults(parameters, example), seed, observer, {});
        possible_cases += possible ? 1U : 0U;
        ASSERT_EQ(model.has_value(), possible) << "seed " << seed;
    }
    EXPECT_GT(possible_cases, 50U);
}

}  // namespace
}  // namespace modelsynth::discrete
