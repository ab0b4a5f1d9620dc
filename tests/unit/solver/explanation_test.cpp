// What is said of failures, checked by trying everything on random tiny requests.

#include "solver/discrete/explanation/contradiction.h"
#include "solver/discrete/explanation/explain.h"
#include "solver/discrete/faults.h"
#include "solver/discrete/synthesis.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"
#include "tests/support/tiny_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::make_example;
using testing::make_tiny_example;
using testing::RecordingObserver;
using testing::TinyOracle;

Result<Synthesis> make(const Example& example, const Parameters& parameters, std::uint64_t seed) {
    RecordingObserver observer;
    return synthesise(example, parameters, seed, observer, {});
}

class CaseMaker {
  public:
    explicit CaseMaker(std::uint64_t seed) : random_({seed, 0, 0, 95}) {}

    Parameters parameters(const Example& example, bool with_member_rules) {
        Parameters made;
        made.size = below(4) == 0 ? GridSize{2, 2, 2} : GridSize{1 + below(3), 1, 1 + below(3)};
        if (below(2) == 0) {
            made.blocks.emplace(std::nullopt);
        }
        for (std::size_t side = 0; side < kDirectionCount; side += 2) {
            for (const std::size_t one : {side, side + 1}) {
                made.boundary[one] = boundary(example);
            }
            if (below(5) == 0) {
                made.boundary[side] = SideBoundary{BoundaryKind::kPeriodic};
                made.boundary[side + 1] = SideBoundary{BoundaryKind::kPeriodic};
            }
        }
        if (below(3) == 0) {
            made.weights = WeightList{{some(example).front(), 0.0}};
        }
        for (std::int32_t left = below(4); left > 0; --left) {
            made.constraints.push_back(constraint(example, *made.size, with_member_rules));
        }
        return fill_defaults(made, example);
    }

  private:
    std::int32_t below(std::int32_t bound) {
        return static_cast<std::int32_t>(random_.below(static_cast<std::uint32_t>(bound)));
    }

    std::vector<std::string> some(const Example& example) {
        std::vector<std::string> names;
        const auto first =
            static_cast<std::size_t>(below(static_cast<std::int32_t>(example.pieces.size())));
        for (std::size_t i = 0; i < example.pieces.size(); ++i) {
            if (i == first || below(3) == 0) {
                names.push_back(example.pieces[i].name);
            }
        }
        return names;
    }

    SideBoundary boundary(const Example& example) {
        switch (below(6)) {
            case 0:
                return {BoundaryKind::kPieces, some(example)};
            case 1:
                return {
                    example.size.cell_count() > 0 ? BoundaryKind::kExample : BoundaryKind::kFree};
            default:
                return {};
        }
    }

    Cell cell(const GridSize& size) { return {below(size.x), below(size.y), below(size.z)}; }

    Constraint constraint(const Example& example, const GridSize& size, bool with_member_rules) {
        Constraint made = {Fixed{}, some(example)};
        if (below(3) > 0) {
            made.region.cells = {cell(size), cell(size)};
        }
        switch (below(with_member_rules ? 9 : 5)) {
            case 0:
                made.rule = Forbidden{};
                break;
            case 1:
                made.rule = Probability{below(2) * 0.5};
                break;
            case 2:
                made = {Symmetry{Symmetry::Kind::kReflectX, {}, NamePairs()}, {}, {}};
                break;
            case 4: {
                if (!with_member_rules) {
                    break;
                }
                const auto cells = static_cast<std::int32_t>(size.cell_count());
                const auto min = static_cast<std::uint32_t>(below(std::min(4, cells + 1)));
                made.rule = Count{min, min + static_cast<std::uint32_t>(below(2))};
                break;
            }
            case 5:
                made.rule = Separation{2 + below(2)};
                break;
            case 6:
                made.rule = MaxRun{1, {}};
                break;
            case 7:
                made.rule = Connected{};
                break;
            case 8:
                made.region = {};
                made.rule = Path{cell(size), cell(size)};
                break;
            default:
                break;
        }
        return made;
    }

    RandomStream random_;
};

// A way to take one cause out of a request.
using Removal = void (*)(Parameters&, std::size_t number);

void open_side(Parameters& parameters, std::size_t side) {
    parameters.boundary[side] = SideBoundary{};
}

void open_axis(Parameters& parameters, std::size_t axis) {
    open_side(parameters, 2 * axis);
    open_side(parameters, 2 * axis + 1);
}

// The others keep their numbers.
void drop_constraint(Parameters& parameters, std::size_t number) {
    parameters.constraints[number].rule = Probability{1};
}

void drop_weight(Parameters& parameters, std::size_t number) {
    auto& list = std::get<WeightList>(*parameters.weights);
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(number));
}

struct Named {
    Removal remove;
    std::size_t number;

    friend bool operator<(const Named& a, const Named& b) {
        return std::pair(a.remove, a.number) < std::pair(b.remove, b.number);
    }
};

std::vector<Named> all_causes(const Parameters& parameters) {
    std::vector<Named> all;
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const BoundaryKind kind = parameters.boundary[side]->kind;
        if (kind == BoundaryKind::kPeriodic) {
            all.push_back({open_axis, side / 2});
        } else if (kind != BoundaryKind::kFree) {
            all.push_back({open_side, side});
        }
    }
    for (std::size_t i = 0; i < parameters.constraints.size(); ++i) {
        all.push_back({drop_constraint, i});
    }
    if (const auto* list = std::get_if<WeightList>(&*parameters.weights)) {
        for (std::size_t i = 0; i < list->size(); ++i) {
            all.push_back({drop_weight, i});
        }
    }
    return all;
}

std::vector<Named> causes_of(const Parameters& parameters, const Contradiction& conflict) {
    std::vector<Named> causes;
    for (const std::string& name : conflict.sides) {
        const auto side = std::find(kSideNames.begin(), kSideNames.end(), name);
        causes.push_back({open_side, static_cast<std::size_t>(side - kSideNames.begin())});
    }
    for (const auto& constraint : conflict.constraints) {
        EXPECT_EQ(
            constraint.kind, kRuleNames.at(parameters.constraints[constraint.index].rule.index())
        );
        causes.push_back({drop_constraint, constraint.index});
    }
    for (const std::string& axis : conflict.periodic) {
        causes.push_back({open_axis, std::string("xyz").find(axis)});
    }
    for (const std::string& name : conflict.removed) {
        const auto& list = std::get<WeightList>(*parameters.weights);
        const auto entry = std::find_if(list.begin(), list.end(), [&name](const auto& one) {
            return one.first == name && one.second == 0;
        });
        EXPECT_NE(entry, list.end());
        causes.push_back({drop_weight, static_cast<std::size_t>(entry - list.begin())});
    }
    return causes;
}

Parameters without(Parameters parameters, const std::set<Named>& unwanted) {
    for (auto cause = unwanted.rbegin(); cause != unwanted.rend(); ++cause) {
        cause->remove(parameters, cause->number);
    }
    return parameters;
}

std::set<std::string> names_of(const Example& example, const std::set<Label>& labels) {
    std::set<std::string> names;
    for (const Label label : labels) {
        names.insert(example.pieces[label].name);
    }
    return names;
}

// What is wrong with a conflict, or nothing.
std::optional<std::string> find_fault(
    const Example& example, const Parameters& parameters, const Contradiction& conflict
) {
    const std::vector<Named> causes = causes_of(parameters, conflict);
    std::set<Named> others;
    for (const Named& cause : all_causes(parameters)) {
        others.insert(cause);
    }
    for (const Named& cause : causes) {
        others.erase(cause);
    }
    const Parameters alone = without(parameters, others);
    if (TinyOracle(example, alone).has_model()) {
        return "the causes can hold together";
    }
    for (const Named& cause : causes) {
        std::set<Named> more = others;
        more.insert(cause);
        const Parameters less = without(parameters, more);
        if (conflict.is_minimal && !TinyOracle(example, less).has_model()) {
            return "a cause can be left out";
        }
    }
    TinyOracle oracle(example, alone);
    std::map<std::size_t, std::set<Label>> held;
    const bool has_symmetry = std::any_of(
        conflict.constraints.begin(),
        conflict.constraints.end(),
        [](const auto& constraint) { return constraint.kind == "symmetry"; }
    );
    for (const auto& [cell, labels] : conflict.cells) {
        held[parameters.size->index(cell)] = oracle.domain(cell);
        // A symmetry forbids labels where a cell is its own image, of which the oracle knows
        // nothing.
        const std::set<std::string> left = names_of(example, oracle.domain(cell));
        const std::set<std::string> told(labels.begin(), labels.end());
        if (!std::includes(left.begin(), left.end(), told.begin(), told.end()) ||
            (left != told && !has_symmetry)) {
            return "the causes leave other labels";
        }
    }
    oracle.open_all();
    for (const auto& [site, labels] : held) {
        oracle.set_domain(parameters.size->cell(site), labels);
    }
    if (oracle.has_model()) {
        return "it does not show at these cells";
    }
    return std::nullopt;
}

struct Tally {
    std::size_t possible = 0;
    std::size_t conflicts = 0;
    std::size_t minimal = 0;
    std::size_t with_cells = 0;
    std::size_t gave_up = 0;
    std::map<std::string, std::size_t> kinds;
};

void check_case(std::uint64_t seed, bool with_member_rules, Tally& tally) {
    const Example example = make_tiny_example(seed, seed % 3 != 0);
    const Parameters parameters = CaseMaker(seed).parameters(example, with_member_rules);
    ASSERT_TRUE(find_faults(example, parameters).empty()) << seed;
    const auto made = make(example, parameters, seed);
    const bool can_be = TinyOracle(example, parameters).has_model();
    if (made) {
        ASSERT_TRUE(can_be) << seed;
        ++tally.possible;
        return;
    }
    if (made.error().code == ErrorCode::kGaveUp) {
        ++tally.gave_up;
        return;
    }
    ASSERT_EQ(made.error().code, ErrorCode::kContradiction) << seed;
    ASSERT_FALSE(can_be) << seed;
    const auto* conflict = std::any_cast<Contradiction>(&made.error().explanation);
    ASSERT_NE(conflict, nullptr) << seed << ": " << made.error().message;
    const auto fault = find_fault(example, parameters, *conflict);
    ASSERT_FALSE(fault) << seed << ": " << *fault << ": " << made.error().message;
    // Where a cell has nothing left that is told, though fewer causes may be in conflict.
    ASSERT_TRUE(
        with_member_rules || conflict->is_minimal ||
        (conflict->cells.size() == 1 && conflict->cells[0].labels.empty() &&
         made.error().message.find("there is none either") != std::string::npos)
    ) << seed
      << ": " << made.error().message;
    ++tally.conflicts;
    tally.minimal += conflict->is_minimal ? 1U : 0U;
    tally.with_cells += conflict->cells.empty() ? 0U : 1U;
    tally.kinds["side"] += conflict->sides.size();
    tally.kinds["periodic"] += conflict->periodic.size();
    tally.kinds["removed"] += conflict->removed.size();
    for (const auto& constraint : conflict->constraints) {
        ++tally.kinds[constraint.kind];
    }
}

TEST(Explanation, OfCellsByThemselvesIsCompleteAndMinimal) {
    Tally tally;
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        ASSERT_NO_FATAL_FAILURE(check_case(seed, false, tally));
    }
    EXPECT_EQ(tally.gave_up, std::size_t{0});
    EXPECT_GT(tally.minimal, tally.conflicts / 2);
    EXPECT_GT(tally.possible, std::size_t{300});
    EXPECT_GT(tally.conflicts, std::size_t{300});
    EXPECT_GT(tally.with_cells, std::size_t{200});
    for (const char* kind :
         {"side", "periodic", "removed", "fixed", "forbidden", "probability", "symmetry"}) {
        EXPECT_GT(tally.kinds[kind], std::size_t{10}) << kind;
    }
}

TEST(Explanation, OfMemberRulesNamesThem) {
    Tally tally;
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        ASSERT_NO_FATAL_FAILURE(check_case(seed, true, tally));
    }
    EXPECT_GT(tally.possible, std::size_t{300});
    EXPECT_GT(tally.conflicts, std::size_t{300});
    EXPECT_GT(tally.minimal, tally.conflicts * 3 / 4);
    EXPECT_LT(tally.gave_up, std::size_t{100});
    for (const char* kind : {"count", "separation", "max_run", "connected", "path"}) {
        EXPECT_GT(tally.kinds[kind], std::size_t{1}) << kind;
    }
}

// Any of a and b beside any.
Example make_any() {
    Example any = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    for (const std::uint8_t axis : {std::uint8_t{0}, std::uint8_t{2}}) {
        for (const Label label : {Label{0}, Label{1}}) {
            any.adjacency.push_back({axis, label, label});
        }
    }
    return any;
}

// Of as many cells as there are, one fewer may hold what is fixed in all of them.
Result<Synthesis> make_one_too_many(std::int32_t cells) {
    Parameters parameters;
    parameters.size = GridSize{cells, 1, 2};
    Constraint fixed = {Fixed{}, {"b"}};
    fixed.region.box = Box{{0, 0, 0}, {cells, 1, 1}};
    parameters.constraints = {fixed, {Count{0, static_cast<std::uint32_t>(cells - 1)}, {"b"}}};
    return make(make_any(), fill_defaults(parameters, make_any()), 1);
}

TEST(Explanation, TellsThirtyTwoCellsAtMost) {
    const Error few = make_one_too_many(32).error();
    EXPECT_EQ(std::any_cast<Contradiction>(few.explanation).cells.size(), std::size_t{32});
    EXPECT_NE(few.message.find("29 more cells"), std::string::npos) << few.message;
    const Error many = make_one_too_many(33).error();
    const auto conflict = std::any_cast<Contradiction>(many.explanation);
    EXPECT_TRUE(conflict.cells.empty());
    EXPECT_EQ(conflict.constraints.size(), std::size_t{2});
    EXPECT_TRUE(conflict.is_minimal);
}

TEST(Explanation, NamesEightCausesAtMost) {
    Parameters parameters;
    parameters.size = GridSize{9, 1, 1};
    for (std::int32_t x = 0; x < 9; ++x) {
        parameters.constraints.push_back({Fixed{}, {"b"}});
        parameters.constraints.back().region.cells = {{x, 0, 0}};
    }
    for (const std::uint32_t most : {6U, 7U, 8U}) {
        parameters.constraints.push_back({Count{0, most}, {"b"}});
        const Error error = make(make_any(), fill_defaults(parameters, make_any()), 1).error();
        const auto conflict = std::any_cast<Contradiction>(error.explanation);
        EXPECT_EQ(conflict.constraints.size(), most + 2);
        EXPECT_TRUE(conflict.is_minimal);
        const std::string last =
            most == 6 ? "(count of \"b\")" : "and " + std::to_string(most - 6) + " more";
        EXPECT_NE(error.message.find(last + " cannot hold together"), std::string::npos)
            << error.message;
        parameters.constraints.pop_back();
    }
}

TEST(Explanation, TellsEightDemandsOnACellAtMost) {
    Parameters parameters;
    parameters.size = GridSize{2, 1, 2};
    for (int i = 0; i < 9; ++i) {
        Constraint fixed = {Fixed{}, {i == 0 ? "a" : "b"}};
        fixed.region.cells = {{1, 0, 1}};
        parameters.constraints.push_back(fixed);
    }
    const Error error = make(make_any(), fill_defaults(parameters, make_any()), 1).error();
    EXPECT_NE(error.message.find("constraint 7 (fixed of \"b\"))"), std::string::npos)
        << error.message;
    EXPECT_EQ(error.message.find("constraint 8"), std::string::npos) << error.message;
}

TEST(Explanation, IsCancelledWhenAsked) {
    Parameters parameters;
    parameters.size = GridSize{2, 1, 2};
    parameters.constraints = {{Count{4, {}}, {"a"}}, {Fixed{}, {"b"}}};
    parameters = fill_defaults(parameters, make_any());
    const auto problem = make_problem(make_any(), parameters);
    ASSERT_TRUE(problem);
    std::stop_source stop;
    stop.request_stop();
    const Error known = {ErrorCode::kContradiction, "known", {}};
    EXPECT_EQ(
        explain(known, make_any(), parameters, *problem, stop.get_token()).code,
        ErrorCode::kCancelled
    );
    EXPECT_NE(explain(known, make_any(), parameters, *problem, {}).message, "known");
}

TEST(Explanation, OfWhatIsPossibleIsWhatWasKnown) {
    Parameters parameters;
    parameters.size = GridSize{2, 1, 2};
    parameters = fill_defaults(parameters, make_any());
    const auto problem = make_problem(make_any(), parameters);
    ASSERT_TRUE(problem);
    const Error known = {ErrorCode::kContradiction, "known", {}};
    EXPECT_EQ(explain(known, make_any(), parameters, *problem, {}).message, "known");
}

// A floor of a's of which one cell is made anew.
class OriginExplanation : public ::testing::Test {
  protected:
    Contradiction conflict_with(const Constraint& constraint) {
        Parameters parameters;
        parameters.size = GridSize{3, 1, 3};
        parameters.constraints = {{Fixed{}, {"a", "b"}}, constraint};
        const Example any = make_any();
        Origin origin = {{3, 1, 3}, std::vector<Label>(9, Label{0})};
        origin.remade.cells = {{1, 0, 1}};
        const auto preparation = Preparation::make(
            std::make_shared<const Example>(any), fill_defaults(parameters, any), &origin
        );
        RecordingObserver observer;
        const Error error =
            preparation ? synthesise(**preparation, 1, observer, {}).error() : preparation.error();
        EXPECT_EQ(error.code, ErrorCode::kContradiction) << error.message;
        EXPECT_NE(error.message.find("the model that this one starts from"), std::string::npos);
        return std::any_cast<Contradiction>(error.explanation);
    }
};

TEST_F(OriginExplanation, NamesWhatIsKeptBesideACount) {
    const Contradiction conflict = conflict_with({Count{2, {}}, {"b"}});
    EXPECT_TRUE(conflict.has_origin);
    ASSERT_EQ(conflict.constraints.size(), std::size_t{1});
    EXPECT_EQ(conflict.constraints[0].index, std::size_t{1});
    EXPECT_EQ(conflict.cells.size(), std::size_t{8});
    EXPECT_TRUE(conflict.is_minimal);
}

TEST_F(OriginExplanation, NamesAKeptCellWhereSomethingElseIsFixed) {
    Constraint fixed = {Fixed{}, {"b"}};
    fixed.region.cells = {{1, 0, 1}, {2, 0, 1}};
    const Contradiction conflict = conflict_with(fixed);
    EXPECT_TRUE(conflict.has_origin);
    ASSERT_EQ(conflict.cells.size(), std::size_t{1});
    EXPECT_EQ(conflict.cells[0].cell, (Cell{2, 0, 1}));
    EXPECT_TRUE(conflict.cells[0].labels.empty());
    EXPECT_TRUE(conflict.is_minimal);
}

}  // namespace
}  // namespace modelsynth::discrete
