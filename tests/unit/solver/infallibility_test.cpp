// Verdicts of infallibility against runs of Algorithm 3.1 and exhaustive search by other code, over
// many random tiny examples.

#include "solver/discrete/analysis/infallibility.h"

#include "solver/core/random.h"
#include "solver/discrete/analysis/corner_condition.h"
#include "solver/discrete/analysis/region_induction.h"
#include "solver/discrete/scan_order.h"
#include "tests/support/case_count.h"
#include "tests/support/examples.h"
#include "tests/support/naive_grid.h"
#include "tests/support/naive_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::are_cases_usual;
using testing::case_count;
using testing::expect_never_fails;
using testing::make_example;
using testing::make_tiny_example;
using testing::NaiveGrid;
using testing::NaiveRules;
using testing::scan;

void expect_counterexample(
    const Example& example, const Counterexample& counterexample, std::uint64_t seed
) {
    const NaiveRules rules(example);
    NaiveGrid grid(rules, counterexample.box);
    ASSERT_TRUE(grid.propagate()) << "seed " << seed;
    const std::vector<Cell> order = scan(counterexample.box);
    ASSERT_LE(
        counterexample.cells.size() + std::size_t{counterexample.choice.has_value()}, order.size()
    );
    for (std::size_t i = 0; i < counterexample.cells.size(); ++i) {
        const PlacedLabel& placed = counterexample.cells[i];
        ASSERT_EQ(placed.cell, order[i]) << "seed " << seed;
        ASSERT_NE(grid.at(placed.cell) & 1U << placed.label, 0U) << "seed " << seed;
        grid.at(placed.cell) = 1U << placed.label;
        ASSERT_TRUE(grid.propagate()) << "seed " << seed;
    }
    if (counterexample.choice) {
        const PlacedLabel& choice = *counterexample.choice;
        ASSERT_EQ(choice.cell, order[counterexample.cells.size()]) << "seed " << seed;
        ASSERT_NE(grid.at(choice.cell) & 1U << choice.label, 0U) << "seed " << seed;
        grid.at(choice.cell) = 1U << choice.label;
    }
    ASSERT_FALSE(grid.has_completion()) << "seed " << seed;
    // So have those that matter alone.
    NaiveGrid core(rules, counterexample.box);
    std::size_t next = 0;
    for (const PlacedLabel& placed : counterexample.core) {
        while (next < counterexample.cells.size() && counterexample.cells[next] != placed) {
            ++next;
        }
        ASSERT_LT(next, counterexample.cells.size()) << "seed " << seed;
        core.at(placed.cell) = 1U << placed.label;
    }
    if (counterexample.choice) {
        core.at(counterexample.choice->cell) = 1U << counterexample.choice->label;
    }
    ASSERT_FALSE(core.has_completion()) << "seed " << seed;
}

std::string text_of(const InfallibilityVerdict& verdict) {
    switch (verdict.kind) {
        case Infallibility::kUnknown:
            return "unknown";
        case Infallibility::kFallible:
            return verdict.counterexample->choice ? "fallible, noticed" : "fallible, unnoticed";
        case Infallibility::kInfallible:
            break;
    }
    return verdict.proof == InfallibilityProof::kRegion
               ? verdict.region->cell_count() > 4 ? "large region" : "small region"
           : verdict.proof == InfallibilityProof::kEquation311 ? "equation"
                                                               : "one axis";
}

InfallibilityVerdict verdict_of(const Example& example, std::uint64_t steps_max) {
    InfallibilityOptions options;
    options.steps_max = steps_max;
    options.search.runs = 2;
    options.search.box_cells_max = 64;
    return judge_infallibility(read_transitions(example), options, {}).value();
}

// Judges random examples and checks each verdict; how often each was given.
std::map<std::string, std::size_t> check_verdicts(
    std::uint64_t cases,
    bool is_planar,
    const std::vector<GridSize>& small,
    const std::vector<GridSize>& large
) {
    std::map<std::string, std::size_t> seen;
    for (std::uint64_t seed = 0; seed < cases; ++seed) {
        const Example example = make_tiny_example(seed, is_planar);
        const InfallibilityVerdict verdict = verdict_of(example, 20'000);
        ++seen[text_of(verdict)];
        EXPECT_FALSE(verdict.description.empty());
        EXPECT_LE(verdict.steps, 20'000U);
        EXPECT_EQ(verdict.counterexample.has_value(), verdict.kind == Infallibility::kFallible);
        if (verdict.kind == Infallibility::kInfallible) {
            expect_never_fails(example, small, large, seed);
        }
        if (verdict.counterexample) {
            expect_counterexample(example, *verdict.counterexample, seed);
        }
        if (::testing::Test::HasFatalFailure()) {
            break;
        }
    }
    return seen;
}

TEST(Infallibility, PlanarVerdictsHoldAgainstBruteForce) {
    const auto seen = check_verdicts(
        case_count(2000),
        true,
        {{2, 1, 2}, {2, 1, 3}, {3, 1, 2}, {3, 1, 3}, {4, 1, 2}, {2, 1, 4}},
        {{4, 1, 4}, {6, 1, 6}, {3, 1, 9}, {9, 1, 3}}
    );
    for (const char* each :
         {"one axis",
          "equation",
          "small region",
          "large region",
          "fallible, noticed",
          "fallible, unnoticed"}) {
        EXPECT_TRUE(!are_cases_usual(2000) || (seen.contains(each) && seen.at(each) > 5)) << each;
    }
}

TEST(Infallibility, SpatialVerdictsHoldAgainstBruteForce) {
    const auto seen = check_verdicts(
        case_count(800), false, {{2, 2, 2}, {3, 2, 2}, {2, 3, 2}, {2, 2, 3}}, {{3, 3, 3}, {4, 4, 4}}
    );
    for (const char* each :
         {"equation", "small region", "fallible, noticed", "fallible, unnoticed"}) {
        EXPECT_TRUE(!are_cases_usual(800) || (seen.contains(each) && seen.at(each) > 2)) << each;
    }
}

// Each proof by itself, where another would have been first.
TEST(Infallibility, EveryProofHoldsByItself) {
    const std::vector<GridSize> small = {{2, 1, 2}, {3, 1, 3}, {4, 1, 2}, {2, 1, 4}};
    std::map<GridSize, std::size_t, bool (*)(const GridSize&, const GridSize&)> proved(
        [](const GridSize& a, const GridSize& b) {
            return std::pair(a.x, a.z) < std::pair(b.x, b.z);
        }
    );
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Example example = make_tiny_example(seed, true);
        const Transitions transitions = read_transitions(example);
        if (transitions.open_count() < 2) {
            continue;
        }
        for (const GridSize& region :
             {GridSize{2, 1, 2}, GridSize{3, 1, 2}, GridSize{2, 1, 3}, GridSize{3, 1, 3}}) {
            Work work(20'000, {});
            if (prove_by_region(transitions, region, work) == ProofOutcome::kProved) {
                ++proved[region];
                expect_never_fails(example, small, {{6, 1, 6}, {3, 1, 7}}, seed);
            }
        }
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_EQ(proved.size(), 4U);
    for (const auto& [region, count] : proved) {
        EXPECT_GE(count, 20U) << region.x << " x " << region.z;
    }
}

// Where Eq. 3.11 holds, so does the induction with the smallest region.
TEST(Infallibility, TheSmallestRegionProvesWhatTheEquationProves) {
    std::size_t by_equation = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const Transitions transitions = read_transitions(make_tiny_example(seed, true));
        Work work(1'000'000, {});
        if (transitions.open_count() == 2 &&
            check_corners(transitions, work) == ProofOutcome::kProved) {
            ++by_equation;
            EXPECT_EQ(prove_by_region(transitions, {2, 1, 2}, work), ProofOutcome::kProved) << seed;
        }
    }
    EXPECT_GT(by_equation, 20U);
}

// The models of the thesis's Figs. 3.1(a) and (b), and lines in empty space.
TEST(Infallibility, TheEquationProvesEmptySpaceChequersAndLines) {
    for (const Example& example :
         {make_example({2, 1, 2}, {0, 0, 0, 0}, 1),
          make_example({3, 1, 3}, {0, 1, 0, 1, 0, 1, 0, 1, 0}, 2),
          make_example({3, 1, 4}, {0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0}, 2),
          make_example({2, 2, 2}, {0, 1, 1, 0, 1, 0, 0, 1}, 2)}) {
        const InfallibilityVerdict verdict = verdict_of(example, 10'000);
        EXPECT_EQ(verdict.proof, InfallibilityProof::kEquation311);
    }
}

// Eq. 3.11 of each plane is not enough in space: three neighbours can leave nothing though any two
// of them leave something.
TEST(Infallibility, InSpaceTheCornersOfCubesAreLookedAt) {
    // Label 1 + i may not follow itself along axis i; all else may. So after 1 along x, 2 along y
    // and 3 along z only 0 can stand.
    Example example = make_example({0, 0, 0}, {}, 4);
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
        for (Label a = 0; a < 4; ++a) {
            for (Label b = 0; b < 4; ++b) {
                if (a != axis + 1 || b != a) {
                    example.adjacency.push_back({axis, a, b});
                }
            }
        }
    }
    const auto outcome = [](const Example& each) {
        Work work(10'000, {});
        return check_corners(read_transitions(each), work);
    };
    EXPECT_EQ(outcome(example), ProofOutcome::kProved);
    Example without = example;
    std::erase_if(without.adjacency, [](const AdjacentPair& pair) {
        return pair.lower == 0 || pair.upper == 0;
    });
    EXPECT_EQ(outcome(without), ProofOutcome::kNotProved);
    for (std::uint8_t closed = 0; closed < 3; ++closed) {
        Example plane = without;
        std::erase_if(plane.adjacency, [closed](const AdjacentPair& pair) {
            return pair.axis == closed;
        });
        EXPECT_EQ(outcome(plane), ProofOutcome::kProved);
    }
}

TEST(Infallibility, IsUnknownWithoutWorkAndNeverAnythingElseWithMore) {
    std::size_t settled = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const Example example = make_tiny_example(seed, true);
        Infallibility before = Infallibility::kUnknown;
        for (const std::uint64_t steps : {0U, 10U, 100U, 1'000U, 30'000U}) {
            const InfallibilityVerdict verdict = verdict_of(example, steps);
            EXPECT_LE(verdict.steps, steps);
            EXPECT_EQ(verdict.steps, verdict_of(example, steps).steps);
            if (before != Infallibility::kUnknown && verdict.kind != Infallibility::kUnknown) {
                EXPECT_EQ(verdict.kind, before) << seed;
            }
            if (steps == 0 && read_transitions(example).open_count() == 2) {
                EXPECT_EQ(verdict.kind, Infallibility::kUnknown);
            }
            before = verdict.kind;
        }
        settled += std::size_t{before != Infallibility::kUnknown};
    }
    EXPECT_GT(settled, 30U);
}

TEST(Infallibility, TellsWhereThereIsNoModelAtAll) {
    // Rows of three labels that end: 0 1 2, and no label follows 2.
    const Example rows = make_example({3, 1, 2}, {0, 1, 2, 0, 1, 2}, 3);
    const InfallibilityVerdict verdict = verdict_of(rows, 10'000);
    EXPECT_EQ(verdict.impossible_from, (GridSize{4, 1, 4}));
    EXPECT_NE(
        verdict.description.find("No model of 4 x 1 x 4 cells or more exists."), std::string::npos
    );
    const Example pillars = testing::make_pillars();
    EXPECT_EQ(verdict_of(pillars, 10'000).impossible_from, std::nullopt);
}

TEST(Infallibility, IsCancelledWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const auto verdict =
        judge_infallibility(read_transitions(testing::make_pillars()), {}, stop.get_token());
    ASSERT_FALSE(verdict);
    EXPECT_EQ(verdict.error().code, ErrorCode::kCancelled);
}

TEST(Infallibility, TheOrderOfItsProofsIsTheOrderOfTheSearch) {
    const GridSize size = {3, 2, 4};
    const std::vector<Site> order = column_order(size);
    const std::vector<Cell> cells = scan(size);
    ASSERT_EQ(order.size(), cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        EXPECT_EQ(size.cell(order[i]), cells[i]);
    }
}

TEST(Infallibility, TheQuickQuestionIsAnsweredYesOnlyWhereTheVerdictIsInfallible) {
    std::size_t proved = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Example example = make_tiny_example(seed, seed % 4 < 2);
        if (!is_proved_infallible(example)) {
            continue;
        }
        ++proved;
        EXPECT_EQ(verdict_of(example, 100'000).kind, Infallibility::kInfallible) << seed;
        // It speaks of free sides alone.
        example.boundary[seed % kDirectionCount].kind = BoundaryKind::kPeriodic;
        EXPECT_FALSE(is_proved_infallible(example));
    }
    EXPECT_GT(proved, 100U);
    EXPECT_TRUE(is_proved_infallible(make_example({2, 1, 2}, {0, 0, 0, 0}, 1)));
    EXPECT_FALSE(is_proved_infallible(make_example({2, 1, 2}, {0, 0, 0, 0}, 1), 0));
}

TEST(Counterexample, IsToldWithTheNamesOfPieces) {
    const Example example = testing::make_pillars();
    const std::vector<PlacedLabel> core = {{{0, 0, 0}, 1}, {{0, 0, 1}, 2}};
    EXPECT_EQ(
        describe({{2, 1, 2}, core, {}, core}, example),
        "In a model of 2 x 1 x 2 cells with \"b\" at [0, 0, 0], \"c\" at [0, 0, 1], every cell has "
        "pieces that seem possible, but nothing completes them."
    );
    EXPECT_EQ(
        describe({{2, 1, 2}, core, PlacedLabel{{1, 0, 0}, 3}, {core[0]}}, example),
        "In a model of 2 x 1 x 2 cells with \"b\" at [0, 0, 0], \"d\" at [1, 0, 0] seems possible, "
        "but nothing completes it."
    );
}

TEST(Completion, AgreesWithBruteForce) {
    std::map<Completion, std::size_t> seen;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const Example example = make_tiny_example(seed, seed % 4 < 2);
        const Transitions transitions = read_transitions(example);
        RandomStream random({seed, 0, 0, 96});
        const GridSize box = {
            3, transitions.open[1] ? 2 : 1, static_cast<std::int32_t>(2 + random.below(2))};
        const NaiveRules rules(example);
        NaiveGrid grid(rules, box);
        std::vector<PlacedLabel> placed;
        for (std::size_t i = 0; i < 3; ++i) {
            const Cell cell = box.cell(random.below(static_cast<std::uint32_t>(box.cell_count())));
            const auto label =
                static_cast<Label>(random.below(static_cast<std::uint32_t>(example.pieces.size())));
            placed.push_back({cell, label});
            grid.at(cell) &= 1U << label;
        }
        Work work(1'000'000, {});
        const Completion completion = find_completion(transitions, box, placed, work);
        ++seen[completion];
        EXPECT_EQ(completion, grid.has_completion() ? Completion::kExists : Completion::kNone)
            << seed;
        Work none(0, {});
        EXPECT_EQ(find_completion(transitions, box, placed, none), Completion::kUnknown);
    }
    EXPECT_GT(seen[Completion::kExists], 40U);
    EXPECT_GT(seen[Completion::kNone], 40U);
}

}  // namespace
}  // namespace modelsynth::discrete
