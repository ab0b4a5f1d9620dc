#include "solver/discrete/analysis/label_facts.h"

#include "solver/discrete/analysis/warnings.h"
#include "tests/support/examples.h"
#include "tests/support/naive_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::make_example;
using testing::make_pillars;
using testing::NaiveGrid;
using testing::NaiveRules;

Parameters sized(const Example& example, const GridSize& size) {
    Parameters parameters;
    parameters.size = size;
    return fill_defaults(parameters, example);
}

LabelFacts facts_of(const Example& example, const GridSize& size) {
    return find_label_facts(example, sized(example, size), {}).value();
}

LabelSet set_of(const Example& example, std::initializer_list<Label> labels) {
    LabelSet set(example.pieces.size());
    for (const Label label : labels) {
        set.insert(label);
    }
    return set;
}

const Warning* find(const std::vector<Warning>& warnings, WarningCode code) {
    const auto found = std::find_if(warnings.begin(), warnings.end(), [code](const Warning& each) {
        return each.code == code;
    });
    return found == warnings.end() ? nullptr : &*found;
}

// Ground a, air b, a pillar c with the cap d.
Example grounded_pillars() {
    Example example = make_pillars();
    example.boundary[static_cast<std::size_t>(Direction::kDown)].kind = BoundaryKind::kExample;
    return example;
}

TEST(LabelFacts, CountLabels) {
    Example example = make_pillars();
    example.pieces.push_back({"e", {}, 0, 1});
    example.pieces.push_back({"f", {}, 0, 1});
    example.adjacency.push_back({0, 1, 5});
    const LabelFacts facts = facts_of(example, {5, 4, 5});
    EXPECT_EQ(facts.counts, (std::vector<std::size_t>{9, 25, 1, 1, 0, 0}));
    EXPECT_EQ(facts.absent, set_of(example, {4}));
    EXPECT_EQ(facts.once, set_of(example, {2, 3}));
}

TEST(LabelFacts, FindWhatIsNextToItself) {
    const Example example = make_pillars();
    const LabelFacts facts = facts_of(example, {5, 4, 5});
    EXPECT_EQ(facts.self_adjacent[0], set_of(example, {0, 1}));
    EXPECT_EQ(facts.self_adjacent[1], set_of(example, {1}));
    EXPECT_EQ(facts.self_adjacent[2], set_of(example, {0, 1}));
    EXPECT_EQ(facts.repeating, set_of(example, {1}));
    EXPECT_TRUE(facts.has_plain_model);
    // In a plane nothing is asked of the third axis.
    const Example planar = make_example({2, 1, 2}, {0, 0, 0, 0}, 1);
    EXPECT_EQ(facts_of(planar, {3, 1, 3}).repeating, set_of(planar, {0}));
    const Example chequers = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    EXPECT_TRUE(facts_of(chequers, {3, 1, 3}).repeating.empty());
    EXPECT_FALSE(facts_of(chequers, {3, 1, 3}).has_plain_model);
}

TEST(LabelFacts, FindWhatTheBoundaryLeavesNoPlace) {
    Example example = make_pillars();
    EXPECT_TRUE(facts_of(example, {5, 4, 5}).unreachable.empty());
    example.boundary[static_cast<std::size_t>(Direction::kDown)] = {BoundaryKind::kPieces, {"b"}};
    EXPECT_EQ(facts_of(example, {5, 4, 5}).unreachable, set_of(example, {0, 2, 3}));
    example.boundary[static_cast<std::size_t>(Direction::kDown)] = {BoundaryKind::kPieces, {"d"}};
    const LabelFacts facts = facts_of(example, {5, 4, 5});
    ASSERT_TRUE(facts.contradiction.has_value());
    EXPECT_TRUE(facts.unreachable.empty());
    EXPECT_NE(facts.contradiction->find("no model of this size"), std::string::npos)
        << *facts.contradiction;
}

// Whether arc consistency leaves the label anywhere, by other code, with free sides.
TEST(LabelFacts, AgreeWithBruteForceOnWhatIsUnreachable) {
    std::size_t unreachable = 0;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        const Example example = testing::make_random_example(seed);
        const GridSize size = {6, 1, 5};
        const NaiveRules rules(example);
        NaiveGrid grid(rules, size);
        const bool is_possible = grid.propagate();
        const LabelFacts facts = facts_of(example, size);
        EXPECT_EQ(facts.contradiction.has_value(), !is_possible);
        std::uint32_t left = 0;
        for_each_cell(Box::whole(size), [&](const Cell& cell) { left |= grid.at(cell); });
        for (Label label = 0; is_possible && label < example.pieces.size(); ++label) {
            const bool is_used = (rules.usable >> label & 1U) != 0;
            const bool is_left = (left >> label & 1U) != 0;
            EXPECT_EQ(facts.unreachable.contains(label), is_used && !is_left) << seed;
            unreachable += std::size_t{is_used && !is_left};
        }
    }
    EXPECT_GT(unreachable, 5U);
}

// A pillar brings its cap and the air around both: five cells on each of two floors. The ground
// below and the air above were known before.
TEST(LabelFacts, FindLabelsThatCopyThePlaceTheyCameFrom) {
    const Example example = grounded_pillars();
    const LabelFacts facts = facts_of(example, {30, 5, 30});
    ASSERT_EQ(facts.forced.size(), 2U);
    EXPECT_EQ(facts.forced[0], (ForcedPatch{2, 5 * 2, set_of(example, {1, 2, 3}), true}));
    // The cap stands on the pillar.
    EXPECT_EQ(facts.forced[1], (ForcedPatch{3, 5 * 2, set_of(example, {1, 2, 3}), true}));
    // With free sides they may stand at the bottom. Then there is no ground anywhere, so no cap two
    // floors up: all of that floor is known to be air.
    const LabelFacts free = facts_of(make_pillars(), {30, 5, 30});
    const auto pillar = std::find_if(free.forced.begin(), free.forced.end(), [](const auto& each) {
        return each.label == 2;
    });
    ASSERT_NE(pillar, free.forced.end());
    EXPECT_EQ(*pillar, (ForcedPatch{2, 5 * 2 + 21 * 21, set_of(example, {1, 2, 3}), false}));
    // A chequerboard is known from one of its cells.
    const Example chequers = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    const LabelFacts chequered = facts_of(chequers, {7, 1, 9});
    ASSERT_EQ(chequered.forced.size(), 2U);
    EXPECT_EQ(chequered.forced[0], (ForcedPatch{0, 63, set_of(chequers, {0, 1}), false}));
}

TEST(LabelFacts, PlaceNoMoreLabelsThanAllowed) {
    const Example example = grounded_pillars();
    const Parameters parameters = sized(example, {30, 5, 30});
    const LabelFacts all = find_label_facts(example, parameters, {}).value();
    EXPECT_TRUE(all.are_forced_complete);
    const LabelFacts none = find_label_facts(example, parameters, {}, 0).value();
    EXPECT_FALSE(none.are_forced_complete);
    EXPECT_TRUE(none.forced.empty());
    EXPECT_EQ(none.unreachable, all.unreachable);
    // The air is placed first; then the pillar, that may stand on one floor only.
    const LabelFacts some = find_label_facts(example, parameters, {}, 2).value();
    EXPECT_FALSE(some.are_forced_complete);
    ASSERT_EQ(some.forced.size(), 1U);
    EXPECT_EQ(some.forced[0], all.forced[0]);
}

TEST(LabelFacts, AreCancelledWhenAsked) {
    const Example example = make_pillars();
    std::stop_source stop;
    stop.request_stop();
    const auto facts = find_label_facts(example, sized(example, {5, 4, 5}), stop.get_token());
    ASSERT_FALSE(facts);
    EXPECT_EQ(facts.error().code, ErrorCode::kCancelled);
}

TEST(Warnings, NameThePieces) {
    Example example = grounded_pillars();
    example.pieces.push_back({"e", {}, 0, 1});
    const auto warnings = list_warnings(example, facts_of(example, {30, 5, 30}));
    const Warning* const absent = find(warnings, WarningCode::kNeverStands);
    ASSERT_NE(absent, nullptr);
    EXPECT_EQ(absent->message, "\"e\" stands nowhere in the example, so it is never used.");
    EXPECT_EQ(absent->labels, (std::vector<Label>{4}));
    const Warning* const once = find(warnings, WarningCode::kStandsOnce);
    ASSERT_NE(once, nullptr);
    EXPECT_EQ(once->labels, (std::vector<Label>{2, 3}));
    EXPECT_EQ(
        once->message,
        "\"c\" and \"d\" stand only once in the example each, so they always have the same "
        "neighbours."
    );
    const Warning* const copy = find(warnings, WarningCode::kForcesCopy);
    ASSERT_NE(copy, nullptr);
    EXPECT_EQ(
        copy->message,
        "Where \"c\" stands, 10 cells are copied from the example, with \"b\" and \"d\"."
    );
    EXPECT_EQ(copy->labels, (std::vector<Label>{2, 1, 3}));
    EXPECT_EQ(find(warnings, WarningCode::kUnreachable), nullptr);
    EXPECT_EQ(find(warnings, WarningCode::kNothingRepeats), nullptr);
    EXPECT_EQ(find(warnings, WarningCode::kNoPlainModel), nullptr);
    EXPECT_EQ(find(warnings, WarningCode::kNothingFits), nullptr);
}

TEST(Warnings, TellWhatTheWholeExampleLacks) {
    const Example chequers = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    const auto warnings = list_warnings(chequers, facts_of(chequers, {7, 1, 9}));
    EXPECT_NE(find(warnings, WarningCode::kNothingRepeats), nullptr);
    EXPECT_NE(find(warnings, WarningCode::kNoPlainModel), nullptr);
    Example impossible = make_pillars();
    impossible.boundary[static_cast<std::size_t>(Direction::kDown)] = {
        BoundaryKind::kPieces, {"d"}};
    const auto others = list_warnings(impossible, facts_of(impossible, {5, 4, 5}));
    ASSERT_FALSE(others.empty());
    EXPECT_EQ(others.front().code, WarningCode::kNothingFits);
    EXPECT_EQ(find(others, WarningCode::kNoPlainModel), nullptr);
    // A plain example of one piece has nothing to be warned of.
    Example plain = make_example({2, 2, 2}, {0, 0, 0, 0, 0, 0, 0, 0}, 1);
    EXPECT_TRUE(list_warnings(plain, facts_of(plain, {4, 4, 4})).empty());
}

TEST(Warnings, HaveCodesOfTheirOwn) {
    std::vector<std::string> names;
    for (const WarningCode code :
         {WarningCode::kNothingFits,
          WarningCode::kNeverStands,
          WarningCode::kUnreachable,
          WarningCode::kStandsOnce,
          WarningCode::kForcesCopy,
          WarningCode::kNothingRepeats,
          WarningCode::kNoPlainModel}) {
        names.emplace_back(name_of(code));
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
    EXPECT_FALSE(names.front().empty());
}

}  // namespace
}  // namespace modelsynth::discrete
