#include "solver/discrete/constraint_reader.h"

#include "solver/core/constraints/acyclic_constraint.h"
#include "solver/core/constraints/connected_constraint.h"
#include "solver/core/constraints/count_constraint.h"
#include "solver/discrete/constraints/run_length_constraint.h"
#include "solver/discrete/constraints/separation_constraint.h"
#include "solver/discrete/likely_mirror.h"
#include "solver/discrete/names.h"
#include "solver/discrete/region.h"
#include "solver/discrete/resemblance.h"
#include "solver/discrete/symmetries.h"

#include <limits>
#include <utility>

namespace modelsynth::discrete {

namespace {

LabelSet complement(const LabelSet& set) {
    LabelSet rest = LabelSet::all(set.label_count());
    for_each_label(set.words(), [&rest](Label label) { rest.erase(label); });
    return rest;
}

// Puts the constraints of a request into the problem: each where it can be told soonest.
class ConstraintReader {
  public:
    ConstraintReader(const Example& example, const Parameters& parameters)
        : example_(example),
          parameters_(parameters),
          labels_(labels_by_name(example)),
          size_(*parameters.size) {}

    // Fails: kTooLarge for too many tables of weights.
    [[nodiscard]] Result<void> read(Problem& problem, WeightTables& weights) const {
        for (std::size_t i = 0; i < parameters_.constraints.size(); ++i) {
            const Constraint& constraint = parameters_.constraints[i];
            const LabelSet named = set_of(labels_, constraint.pieces);
            if (std::holds_alternative<Fixed>(constraint.rule)) {
                narrow(constraint.region, named, problem);
            } else if (std::holds_alternative<Forbidden>(constraint.rule)) {
                narrow(constraint.region, complement(named), problem);
            } else if (const auto* rule = std::get_if<Probability>(&constraint.rule)) {
                if (!weigh(i, rule->weight, named, problem, weights)) {
                    return tl::unexpected(Error{
                        ErrorCode::kTooLarge,
                        "the probabilities come to more than " + std::to_string(kWeightTablesMax) +
                            " different tables of weights; use masks of fewer grey values",
                        {}});
                }
            } else if (is_member_rule(constraint.rule)) {
                add_member_rule(i, named, problem);
            }
        }
        problem.symmetries = read_symmetries(problem);
        return {};
    }

  private:
    void narrow(const Region& region, const LabelSet& allowed, Problem& problem) const {
        const RegionCoverage coverage(region, size_);
        for_each_cell(Box::whole(size_), [&](const Cell& cell) {
            if (coverage.contains(cell)) {
                problem.domains.narrow(static_cast<Site>(size_.index(cell)), allowed);
            }
        });
    }

    bool weigh(
        std::size_t number,
        double weight,
        const LabelSet& named,
        Problem& problem,
        WeightTables& weights
    ) const {
        const RegionCoverage coverage(parameters_.constraints[number].region, size_);
        const LabelSet others = complement(named);
        bool fits = true;
        for_each_cell(Box::whole(size_), [&](const Cell& cell) {
            const double factor = 1 + coverage.at(cell) * (weight - 1);
            const auto site = static_cast<Site>(size_.index(cell));
            if (factor <= 0) {
                problem.domains.narrow(site, others);
            } else if (factor != 1 && fits) {
                fits = weights.multiply(site, number, named, factor);
            }
        });
        return fits;
    }

    void add_member_rule(std::size_t number, const LabelSet& named, Problem& problem) const {
        const Constraint& constraint = parameters_.constraints[number];
        const RegionCoverage coverage(constraint.region, size_);
        MemberRule rule = {number, constraint.rule, named, {}};
        if (!coverage.is_everywhere()) {
            for_each_cell(Box::whole(size_), [&](const Cell& cell) {
                rule.applies.push_back(coverage.contains(cell) ? 1 : 0);
            });
        }
        if (const auto* path = std::get_if<Path>(&constraint.rule)) {
            for (const Cell& end : {path->from, path->to}) {
                problem.domains.narrow(static_cast<Site>(size_.index(end)), named);
            }
        }
        const bool needs_topology = std::holds_alternative<Connected>(constraint.rule) ||
                                    std::holds_alternative<Acyclic>(constraint.rule) ||
                                    std::holds_alternative<Path>(constraint.rule);
        if (needs_topology && problem.topology == nullptr) {
            problem.topology = std::make_unique<GridTopology>(size_, problem.periodic);
        }
        problem.member_rules.push_back(std::move(rule));
    }

    [[nodiscard]] std::unique_ptr<const Symmetries> read_symmetries(const Problem& problem) const {
        std::vector<Symmetries::Generator> generators;
        for (const Constraint& constraint : parameters_.constraints) {
            if (const auto* symmetry = std::get_if<Symmetry>(&constraint.rule)) {
                const NamePairs mirror =
                    symmetry->mirror ? *symmetry->mirror : likely_mirror(example_, symmetry->kind);
                generators.push_back(
                    {CellMap(*symmetry, constraint.region, size_, problem.periodic),
                     label_images(labels_.size(), pairs_of(labels_, mirror))}
                );
            }
        }
        return generators.empty()
                   ? nullptr
                   : std::make_unique<const Symmetries>(
                         size_, problem.periodic, problem.relations, std::move(generators)
                     );
    }

    const Example& example_;
    const Parameters& parameters_;
    LabelOfName labels_;
    GridSize size_;
};

std::unique_ptr<SetConstraint> make_set_constraint(const Problem& problem, const Rule& rule) {
    if (const auto* count = std::get_if<Count>(&rule)) {
        constexpr std::uint32_t kAny = std::numeric_limits<std::uint32_t>::max();
        return std::make_unique<CountConstraint>(count->min, count->max.value_or(kAny));
    }
    if (const auto* separation = std::get_if<Separation>(&rule)) {
        return std::make_unique<SeparationConstraint>(
            problem.size, problem.periodic, separation->distance
        );
    }
    if (const auto* run = std::get_if<MaxRun>(&rule)) {
        return std::make_unique<RunLengthConstraint>(
            problem.size, problem.periodic, run->max, run->axis
        );
    }
    if (std::holds_alternative<Acyclic>(rule)) {
        return std::make_unique<AcyclicConstraint<GridTopology>>(*problem.topology);
    }
    if (const auto* path = std::get_if<Path>(&rule)) {
        return std::make_unique<ConnectedConstraint<GridTopology>>(
            *problem.topology,
            static_cast<Site>(problem.size.index(path->from)),
            static_cast<Site>(problem.size.index(path->to))
        );
    }
    check(std::holds_alternative<Connected>(rule), "a rule that is no member rule");
    return std::make_unique<ConnectedConstraint<GridTopology>>(*problem.topology);
}

}  // namespace

Result<void> read_constraints(
    const Example& example, const Parameters& parameters, Problem& problem, WeightTables& weights
) {
    return ConstraintReader(example, parameters).read(problem, weights);
}

std::unique_ptr<const LabelChooser> make_chooser(
    const Example& example, const Parameters& parameters, const Problem& problem
) {
    for (const Constraint& constraint : parameters.constraints) {
        if (const auto* resemblance = std::get_if<Resemblance>(&constraint.rule)) {
            return std::make_unique<ResemblanceChooser>(
                example, *resemblance, problem.size, problem.periodic, problem.weights.table(0)
            );
        }
    }
    return nullptr;
}

std::unique_ptr<ConstraintBoard> make_board(
    const Problem& problem, std::span<const MemberRule> rules
) {
    auto board = std::make_unique<ConstraintBoard>(problem.size.cell_count());
    for (const MemberRule& rule : rules) {
        board->add(rule.labels, rule.applies, make_set_constraint(problem, rule.rule));
    }
    return board;
}

}  // namespace modelsynth::discrete
