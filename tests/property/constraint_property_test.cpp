#include "solver/core/random.h"
#include "solver/discrete/faults.h"
#include "solver/discrete/likely_mirror.h"
#include "solver/discrete/problem.h"
#include "solver/discrete/synthesis.h"
#include "tests/support/case_count.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/constraint_oracle.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>
#include <string>

namespace modelsynth::discrete {
namespace {

using testing::ConstraintOracle;
using testing::find_inconsistency;
using testing::make_random_example;
using testing::RecordingObserver;

struct Case {
    Example example;
    Parameters parameters;
    std::array<bool, 3> periodic = {false, false, false};
};

class CaseMaker {
  public:
    explicit CaseMaker(std::uint64_t seed) : random_({seed, 2, 0, 99}) {}

    std::int32_t below(std::int32_t bound) {
        return static_cast<std::int32_t>(random_.below(static_cast<std::uint32_t>(bound)));
    }

    Cell cell(const GridSize& size) { return {below(size.x), below(size.y), below(size.z)}; }

    Region region(const GridSize& size) {
        Region region;
        switch (below(6)) {
            case 0: {
                const Cell min = cell(size);
                const Cell past = {size.x - min.x, size.y - min.y, size.z - min.z};
                region.box =
                    Box{min,
                        {min.x + 1 + below(past.x),
                         min.y + 1 + below(past.y),
                         min.z + 1 + below(past.z)}};
                break;
            }
            case 1: {
                Mask mask = {1 + below(4), 1 + below(4), {}, ""};
                for (std::int32_t i = 0; i < mask.width * mask.depth; ++i) {
                    mask.values.push_back(static_cast<std::uint8_t>(85 * below(4)));
                }
                region.mask = mask;
                break;
            }
            case 2: {
                Voxels voxels = {{1 + below(3), 1 + below(3), 1 + below(3)}, {}};
                for (std::size_t i = 0; i < voxels.size.cell_count(); ++i) {
                    voxels.values.push_back(below(3) * 0.5);
                }
                region.voxels = voxels;
                break;
            }
            default:
                break;
        }
        return region;
    }

    Constraint constraint(const Example& example, const GridSize& size, std::size_t kind) {
        Constraint made;
        made.pieces = {example.pieces[0].name};
        for (const Piece& piece : example.pieces) {
            if (below(2) == 0 && piece.name != "a") {
                made.pieces.push_back(piece.name);
            }
        }
        if (below(2) == 0 && made.pieces.size() > 1) {
            made.pieces.erase(made.pieces.begin());
        }
        made.region = region(size);
        switch (kind) {
            case 0:
                made.rule = Fixed{};
                break;
            case 1:
                made.rule = Forbidden{};
                break;
            case 2:
                made.rule = Probability{below(2) * 5.0};
                break;
            case 3: {
                const auto min = static_cast<std::uint32_t>(below(6));
                made.rule = Count{min, std::nullopt};
                if (below(3) == 0) {
                    std::get<Count>(made.rule).max = min + static_cast<std::uint32_t>(below(8));
                }
                break;
            }
            case 4:
                made.rule = Separation{1 + below(4)};
                break;
            case 5:
                made.rule = MaxRun{1 + below(4), {}};
                if (below(2) == 0) {
                    std::get<MaxRun>(made.rule).axis = static_cast<std::uint8_t>(below(3));
                }
                break;
            case 6:
                made.rule = Connected{};
                break;
            case 7:
                made.rule = Acyclic{};
                break;
            case 8:
                made.region = {};
                made.rule = Path{cell(size), cell(size)};
                break;
            case 9:
                made.rule = symmetry(example);
                break;
            case 10:
                made.region = {};
                made.rule = Resemblance{1 + below(2), below(3)};
                break;
            case 11:
                made.rule = Objective{terms(example, size), below(3) * 0.1};
                break;
            default:
                made.rule = BestOf{terms(example, size), static_cast<std::uint32_t>(1 + below(4))};
                break;
        }
        if (!names_pieces(made.rule)) {
            made.pieces.clear();
        }
        return made;
    }

    Symmetry symmetry(const Example& example) {
        constexpr std::array<Symmetry::Kind, 5> kMoves = {
            Symmetry::Kind::kReflectX,
            Symmetry::Kind::kReflectZ,
            Symmetry::Kind::kHalfTurn,
            Symmetry::Kind::kQuarterTurn,
            Symmetry::Kind::kTranslate};
        Symmetry made = {kMoves.at(static_cast<std::size_t>(below(5)))};
        made.translation = {1 + below(4), below(2), below(4) - 2};
        if (below(2) == 0 && example.pieces.size() > 1) {
            made.mirror = NamePairs{{example.pieces[0].name, example.pieces[1].name}};
        } else {
            made.mirror = below(2) == 0 ? NamePairs() : likely_mirror(example, made.kind);
        }
        return made;
    }

    std::vector<Term> terms(const Example& example, const GridSize& size) {
        std::vector<Term> made;
        for (std::int32_t i = 0; i <= below(3); ++i) {
            Term term = {below(2) == 0 ? Term::Kind::kDensity : Term::Kind::kCount};
            term.weight = below(5) - 2;
            term.pieces = {example.pieces[0].name};
            if (below(2) == 0) {
                term.target = term.kind == Term::Kind::kDensity ? 0.5 : size.x;
            }
            if (below(4) == 0) {
                term = {Term::Kind::kHeightProfile, 1, {}, std::nullopt, {0.9, 0.1}};
            }
            made.push_back(term);
        }
        return made;
    }

    Case make(std::uint64_t seed, const GridSize& most, std::size_t kind) {
        Case made = {make_random_example(seed), {}, {}};
        Parameters& parameters = made.parameters;
        parameters.size = GridSize{1 + below(most.x), 1 + below(most.y), 1 + below(most.z)};
        Blocks blocks;
        blocks.layout.size = {2 + below(7), 1 + below(5), 2 + below(7)};
        blocks.layout.passes = static_cast<std::uint32_t>(1 + below(2));
        if (kind == kSymmetryKind) {
            parameters.size->z = parameters.size->x;  // so that it can be turned
        }
        if (below(3) > 0 || kind == kObjectiveKind) {
            parameters.blocks = blocks;
        } else {
            parameters.blocks = std::optional<Blocks>();
        }
        constexpr std::array<Order, 5> kOrders = {
            Order::kScan, Order::kMinEntropy, Order::kFewestLabels, Order::kRandom, Order::kGrowth};
        parameters.order.order = kOrders.at(static_cast<std::size_t>(below(5)));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            made.periodic[axis] = below(4) == 0;
            for (const std::size_t side : {2 * axis, 2 * axis + 1}) {
                SideBoundary boundary;
                if (made.periodic[axis]) {
                    boundary.kind = BoundaryKind::kPeriodic;
                }
                parameters.boundary[side] = boundary;
            }
        }
        parameters.constraints.push_back(constraint(made.example, *parameters.size, kind));
        if (below(3) == 0) {  // and another one beside it
            parameters.constraints.push_back(
                constraint(made.example, *parameters.size, static_cast<std::size_t>(below(kKinds)))
            );
        }
        parameters = fill_defaults(parameters, made.example);
        return made;
    }

    static constexpr std::int32_t kKinds = std::variant_size_v<Rule>;
    static constexpr std::size_t kSymmetryKind = 9;
    static constexpr std::size_t kObjectiveKind = 11;

  private:
    RandomStream random_;
};

void expect_all_hold(const Case& wanted, std::span<const Label> labels, const std::string& where) {
    const GridSize size = *wanted.parameters.size;
    ASSERT_EQ(find_inconsistency(wanted.example, size, labels, wanted.periodic), std::nullopt)
        << where;
    const ConstraintOracle oracle(wanted.example, size, wanted.periodic, labels);
    for (const Constraint& constraint : wanted.parameters.constraints) {
        ASSERT_EQ(oracle.find_violation(constraint), std::nullopt)
            << where << ": " << kRuleNames.at(constraint.rule.index());
    }
}

TEST(ConstraintProperty, HoldInEveryStateOfTheModel) {
    std::map<std::size_t, std::size_t> solved;
    std::size_t gave_up = 0;
    for (std::uint64_t seed = 0; seed < testing::case_count(3000); ++seed) {
        const std::size_t kind = seed % CaseMaker::kKinds;
        const Case wanted = CaseMaker(seed).make(seed, {11, 4, 11}, kind);
        const auto faults = find_faults(wanted.example, wanted.parameters);
        if (!faults.empty()) {
            continue;  // a count of more cells than there are
        }
        RecordingObserver observer;
        const auto model = synthesise(wanted.example, wanted.parameters, seed, observer, {});
        if (!model) {
            gave_up += model.error().code == ErrorCode::kGaveUp ? 1U : 0U;
            ASSERT_TRUE(
                model.error().code == ErrorCode::kContradiction ||
                model.error().code == ErrorCode::kGaveUp
            ) << "seed "
              << seed;
            continue;
        }
        ++solved[kind];
        const std::string name = "seed " + std::to_string(seed);
        expect_all_hold(wanted, model->labels, name);
        if (!observer.initial_model.empty()) {
            expect_all_hold(wanted, observer.initial_model, name + ", initial model");
        }
        for (std::size_t block = 0; block < observer.models.size(); ++block) {
            expect_all_hold(
                wanted, observer.models[block], name + ", block " + std::to_string(block)
            );
        }
        if (HasFatalFailure()) {
            return;
        }
    }
    if (testing::are_cases_usual(3000)) {
        for (std::size_t kind = 0; kind < CaseMaker::kKinds; ++kind) {
            EXPECT_GT(solved[kind], testing::case_count(3000) / CaseMaker::kKinds / 4)
                << kRuleNames.at(kind);
        }
        EXPECT_LT(gave_up, testing::case_count(3000) / 20);
    }
}

// All models of a tiny size, by brute force; one has to be found exactly when there is one, and
// "contradiction" said only when there is none.
TEST(ConstraintProperty, ATinyModelIsFoundExactlyWhenThereIsOne) {
    std::map<bool, std::size_t> cases;
    for (std::uint64_t seed = 0; seed < testing::case_count(3000) / 3; ++seed) {
        Case wanted = CaseMaker(seed).make(
            seed, {1, 1, 1}, static_cast<std::size_t>(seed % CaseMaker::kKinds)
        );
        const GridSize size = {3, 1, 2};
        CaseMaker maker(seed + 10'000);
        wanted.parameters.size = size;
        wanted.parameters.constraints = {maker.constraint(
            wanted.example, size, static_cast<std::size_t>(seed % CaseMaker::kKinds)
        )};
        const std::size_t labels = wanted.example.pieces.size();
        const std::set<Label> used(wanted.example.cells.begin(), wanted.example.cells.end());
        std::vector<Label> cells(size.cell_count(), 0);
        bool possible = false;
        for (bool more = true; more && !possible;) {
            const ConstraintOracle oracle(wanted.example, size, wanted.periodic, cells);
            possible =
                std::all_of(
                    cells.begin(), cells.end(), [&](Label label) { return used.contains(label); }
                ) &&
                !find_inconsistency(wanted.example, size, cells, wanted.periodic) &&
                !oracle.find_violation(wanted.parameters.constraints[0]);
            more = false;
            for (Label& cell : cells) {
                if (++cell < labels) {
                    more = true;
                    break;
                }
                cell = 0;
            }
        }
        if (!find_faults(wanted.example, wanted.parameters).empty()) {
            ASSERT_FALSE(possible) << "seed " << seed;
            continue;
        }
        ++cases[possible];
        RecordingObserver observer;
        const auto model = synthesise(wanted.example, wanted.parameters, seed, observer, {});
        ASSERT_EQ(model.has_value(), possible)
            << "seed " << seed << " "
            << kRuleNames.at(wanted.parameters.constraints[0].rule.index());
    }
    if (testing::are_cases_usual(3000)) {
        EXPECT_GT(cases[true], testing::case_count(3000) / 9);
        EXPECT_GT(cases[false], testing::case_count(3000) / 30);
    }
}

}  // namespace
}  // namespace modelsynth::discrete
