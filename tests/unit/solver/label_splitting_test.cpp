// Splittings against what they promise: f maps models to models, no run of Algorithm 3.1 fails, and
// what is split by rules loses only models that do not go on.

#include "solver/discrete/analysis/label_splitting.h"

#include "solver/discrete/analysis/completion.h"
#include "solver/discrete/analysis/corner_condition.h"
#include "solver/discrete/analysis/infallibility.h"
#include "solver/discrete/analysis/region_induction.h"
#include "tests/support/examples.h"
#include "tests/support/naive_grid.h"
#include "tests/support/naive_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::expect_never_fails;
using testing::make_example;
using testing::make_tiny_example;
using testing::NaiveGrid;
using testing::NaiveRules;

// The figure's rows, the top one first, x upwards and z to the right: so cells are labelled in the
// order of the thesis, from left to right and then upwards.
Example make_figure(const std::vector<std::string>& rows, std::size_t labels) {
    const auto height = static_cast<std::int32_t>(rows.size());
    const auto width = static_cast<std::int32_t>(rows[0].size());
    std::vector<Label> cells;
    for (std::size_t column = 0; column < rows[0].size(); ++column) {
        for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
            cells.push_back(static_cast<Label>((*row)[column] - '0'));
        }
    }
    return make_example({height, 1, width}, std::move(cells), labels);
}

// Fig. 3.5(a) is only described in the text: every 2 has a 6 two spaces to its right and above it
// a 3 or a 7, joined by two paths.
Example make_figure_3_5() {
    return make_figure({"0000000000", "0000003450", "0345007080", "1216112161"}, 9);
}

// So is Fig. 3.6(a): pairs of 2 joined by paths that are two spaces wide, and of any height. Here x
// is to the right, so that columns are labelled one after the other.
Example make_figure_3_6() {
    return make_example(
        {7, 1, 5},
        {0, 0, 2, 0, 2, 0, 0,  //
         0, 0, 1, 0, 1, 0, 0,  //
         0, 0, 1, 0, 1, 0, 0,  //
         0, 0, 3, 4, 5, 0, 0,  //
         0, 0, 0, 0, 0, 0, 0},
        6
    );
}

Infallibility verdict_of(const Transitions& transitions) {
    InfallibilityOptions options;
    options.steps_max = 100'000;
    return judge_infallibility(transitions, options, {}).value().kind;
}

std::optional<Splitting> splitting_of(const Example& example, std::uint64_t steps_max = 50'000) {
    SplittingOptions options;
    options.steps_max = steps_max;
    return find_splitting(example, read_transitions(example), options, {}).value();
}

// The labels of a splitting with its rules, as an example.
Example as_example(const Splitting& splitting) {
    Example example = make_example({0, 0, 0}, {}, splitting.originals.size());
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
        for (Label a = 0; a < splitting.originals.size(); ++a) {
            for (Label b = 0; b < splitting.originals.size(); ++b) {
                if (splitting.transitions.relations.allows(
                        static_cast<RelationId>(2 * axis), a, b
                    )) {
                    example.adjacency.push_back({axis, a, b});
                }
            }
        }
    }
    return example;
}

std::size_t copies_of(const Splitting& splitting, Label original) {
    return static_cast<std::size_t>(
        std::count(splitting.originals.begin(), splitting.originals.end(), original)
    );
}

// Models of a size of a plane, with all that is needed to tell which are kept.
class ModelWalk {
  public:
    ModelWalk(const Example& example, const Splitting& splitting, const GridSize& size)
        : rules_(example),
          split_rules_(as_example(splitting)),
          splitting_(splitting),
          size_(size) {}

    // Calls visit(model, whether it is f of a model) for at most `most` models.
    template <class Visit>
    void run(std::size_t most, const Visit& visit) {
        left_ = most;
        walk(NaiveGrid(rules_, size_), 0, visit);
    }

  private:
    template <class Visit>
    void walk(NaiveGrid grid, std::size_t next, const Visit& visit) {
        if (!grid.propagate()) {
            return;
        }
        if (next == size_.cell_count()) {
            if (left_ > 0) {
                --left_;
                visit(model_, is_kept());
            }
            return;
        }
        const std::uint32_t offered = grid.at(size_.cell(next));
        for (Label label = 0; label < 32 && left_ > 0; ++label) {
            if ((offered >> label & 1U) != 0) {
                grid.at(size_.cell(next)) = 1U << label;
                model_.push_back(label);
                walk(grid, next + 1, visit);
                model_.pop_back();
            }
        }
    }

    [[nodiscard]] bool is_kept() const {
        NaiveGrid grid(split_rules_, size_);
        for (std::size_t cell = 0; cell < model_.size(); ++cell) {
            std::uint32_t copies = 0;
            for (std::size_t i = 0; i < splitting_.originals.size(); ++i) {
                copies |= splitting_.originals[i] == model_[cell] ? 1U << i : 0U;
            }
            grid.at(size_.cell(cell)) &= copies;
        }
        return grid.has_completion();
    }

    NaiveRules rules_;
    NaiveRules split_rules_;
    const Splitting& splitting_;
    GridSize size_;
    std::vector<Label> model_;
    std::size_t left_ = 0;
};

// f maps neighbours to neighbours, and no label was made up.
void expect_sound(const Example& example, const Splitting& splitting, std::uint64_t seed) {
    const NaiveRules rules(example);
    ASSERT_EQ(splitting.transitions.relations.label_count(), splitting.originals.size());
    for (const AdjacentPair& pair : as_example(splitting).adjacency) {
        const Label lower = splitting.originals[pair.lower];
        const Label upper = splitting.originals[pair.upper];
        ASSERT_NE(rules.after.at(pair.axis).at(lower) >> upper & 1U, 0U) << "seed " << seed;
    }
    for (Label label = 0; label < example.pieces.size(); ++label) {
        const bool is_lost = (rules.usable >> label & 1U) != 0 && copies_of(splitting, label) == 0;
        ASSERT_EQ(splitting.lost.contains(label), is_lost) << "seed " << seed;
    }
}

// The verdict is one of the proofs, by itself.
void expect_proved(const Splitting& splitting, std::uint64_t seed) {
    Work work(1'000'000, {});
    const Transitions& transitions = splitting.transitions;
    const ProofOutcome outcome =
        splitting.proof == SplitProof::kEquation311
            ? check_corners(transitions, work)
            : prove_by_region(transitions, smallest_region(transitions.open), work);
    ASSERT_EQ(outcome, ProofOutcome::kProved) << "seed " << seed;
}

// What is lost by rules ends: a model that is a part of a much larger one is kept.
void expect_kept(const Example& example, const Splitting& splitting, std::uint64_t seed) {
    const GridSize size = {3, 1, 3};
    const GridSize larger = {12, 1, 12};
    std::size_t lost = 0;
    ModelWalk(example, splitting, size).run(200, [&](const std::vector<Label>& model, bool kept) {
        if (kept || ++lost > 4) {
            return;
        }
        std::vector<PlacedLabel> placed;
        for (std::size_t cell = 0; cell < model.size(); ++cell) {
            placed.push_back({size.cell(cell), model[cell]});
        }
        Work work(300, {});
        ASSERT_NE(
            find_completion(read_transitions(example), larger, placed, work), Completion::kExists
        ) << "seed "
          << seed;
    });
}

TEST(LabelSplitting, TellsAZeroOfThesisFigure35Apart) {
    const Example example = make_figure_3_5();
    EXPECT_EQ(verdict_of(read_transitions(example)), Infallibility::kFallible);
    const auto splitting = splitting_of(example);
    ASSERT_TRUE(splitting);
    EXPECT_EQ(splitting->method, SplitMethod::kRules);
    EXPECT_TRUE(splitting->lost.empty());
    // The 0 within the higher path, which the thesis calls 9, and the ground below either path.
    EXPECT_EQ(copies_of(*splitting, 0), 2U);
    EXPECT_EQ(copies_of(*splitting, 1), 2U);
    EXPECT_EQ(splitting->originals.size(), 11U);
    EXPECT_EQ(verdict_of(splitting->transitions), Infallibility::kInfallible);
    expect_sound(example, *splitting, 0);
    expect_proved(*splitting, 0);
    expect_never_fails(as_example(*splitting), {{3, 1, 3}, {4, 1, 4}}, {{6, 1, 12}}, 0);
    for (const std::int32_t extent : {3, 4, 5}) {
        std::size_t models = 0;
        ModelWalk(example, *splitting, {extent, 1, extent}).run(1000, [&](const auto&, bool kept) {
            ++models;
            EXPECT_TRUE(kept);
        });
        EXPECT_GT(models, 20U);
    }
}

TEST(LabelSplitting, TellsTheInsideOfThesisFigure36Apart) {
    const Example example = make_figure_3_6();
    EXPECT_NE(verdict_of(read_transitions(example)), Infallibility::kInfallible);
    const auto splitting = splitting_of(example);
    ASSERT_TRUE(splitting);
    EXPECT_EQ(splitting->method, SplitMethod::kCells);
    EXPECT_TRUE(splitting->lost.empty());
    EXPECT_EQ(copies_of(*splitting, 0), 2U);
    EXPECT_EQ(copies_of(*splitting, 1), 2U);
    EXPECT_EQ(splitting->originals.size(), 8U);
    EXPECT_EQ(verdict_of(splitting->transitions), Infallibility::kInfallible);
    expect_sound(example, *splitting, 0);
    expect_proved(*splitting, 0);
    expect_never_fails(as_example(*splitting), {{3, 1, 3}, {4, 1, 4}}, {{9, 1, 9}}, 0);
    for (const std::int32_t extent : {3, 4}) {
        ModelWalk(example, *splitting, {extent, 1, extent}).run(1000, [](const auto&, bool kept) {
            EXPECT_TRUE(kept);
        });
    }
}

// How often splitting was found for examples that are not proved infallible.
std::map<std::string, std::size_t> check_splittings(std::uint64_t cases, bool is_planar) {
    std::map<std::string, std::size_t> seen;
    for (std::uint64_t seed = 0; seed < cases; ++seed) {
        const Example example = make_tiny_example(seed, is_planar);
        const Transitions transitions = read_transitions(example);
        InfallibilityOptions options;
        options.steps_max = 5'000;
        options.search.runs = 1;
        options.search.box_cells_max = 64;
        const auto verdict = judge_infallibility(transitions, options, {}).value();
        if (verdict.kind == Infallibility::kInfallible) {
            continue;
        }
        const auto splitting = splitting_of(example, 20'000);
        if (!splitting) {
            ++seen["none"];
            continue;
        }
        const bool is_by_rules = splitting->method == SplitMethod::kRules;
        ++seen[is_by_rules ? "rules" : "cells"];
        expect_sound(example, *splitting, seed);
        expect_proved(*splitting, seed);
        if (splitting->originals.size() <= 32) {
            const std::vector<GridSize> small =
                is_planar ? std::vector<GridSize>{{2, 1, 2}, {3, 1, 3}, {4, 1, 2}, {2, 1, 4}}
                          : std::vector<GridSize>{{2, 2, 2}, {3, 2, 2}, {2, 2, 3}};
            expect_never_fails(as_example(*splitting), small, {{5, is_planar ? 1 : 3, 5}}, seed);
        }
        if (is_planar && is_by_rules && splitting->originals.size() <= 32) {
            expect_kept(example, *splitting, seed);
        }
        if (::testing::Test::HasFatalFailure()) {
            break;
        }
    }
    return seen;
}

TEST(LabelSplitting, PlanarSplittingsHoldAgainstBruteForce) {
    auto seen = check_splittings(600, true);
    EXPECT_GT(seen["rules"], 30U);
    EXPECT_GT(seen["cells"], 5U);
    EXPECT_GT(seen["none"], 30U);
    for (const auto& [key, count] : seen) {
        RecordProperty(key, static_cast<int>(count));
    }
}

TEST(LabelSplitting, SpatialSplittingsHoldAgainstBruteForce) {
    auto seen = check_splittings(150, false);
    EXPECT_GT(seen["rules"] + seen["cells"], 5U);
}

TEST(LabelSplitting, FindsNothingWithoutWorkAndKeepsToItsLabels) {
    const Example example = make_figure_3_5();
    EXPECT_FALSE(splitting_of(example, 0));
    SplittingOptions options;
    options.labels_per_label = 1;
    options.labels_more = 0;
    EXPECT_FALSE(find_splitting(example, read_transitions(example), options, {}).value());
}

TEST(LabelSplitting, IsCancelledWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const Example example = make_figure_3_5();
    const auto splitting = find_splitting(example, read_transitions(example), {}, stop.get_token());
    ASSERT_FALSE(splitting);
    EXPECT_EQ(splitting.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace modelsynth::discrete
