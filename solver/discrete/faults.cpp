#include "solver/discrete/faults.h"

#include "solver/discrete/names.h"
#include "solver/discrete/region.h"
#include "solver/discrete/resemblance.h"
#include "solver/discrete/symmetries.h"

#include <array>
#include <utility>

namespace modelsynth::discrete {

namespace {

std::size_t opposite(std::size_t side) { return side ^ 1U; }

void find_unknown_pieces(
    const LabelOfName& labels,
    const std::vector<std::string>& names,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (!labels.contains(names[i])) {
            faults.push_back(
                {pointer + "/" + std::to_string(i), "the example has no piece \"" + names[i] + "\""}
            );
        }
    }
}

void find_boundary_faults(
    const Example& example,
    const LabelOfName& labels,
    const Parameters& parameters,
    std::vector<Fault>& faults
) {
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const SideBoundary& boundary = *parameters.boundary[side];
        const std::string pointer = std::string("/boundary/") + kSideNames[side];
        if (boundary.kind == BoundaryKind::kPieces && boundary.is_list) {
            find_unknown_pieces(labels, boundary.pieces, pointer, faults);
        } else if (boundary.kind == BoundaryKind::kPieces && !labels.contains(boundary.pieces[0])) {
            faults.push_back({pointer, "the example has no piece \"" + boundary.pieces[0] + "\""});
        }
        if (boundary.kind == BoundaryKind::kExample && example.size.cell_count() == 0) {
            faults.push_back({pointer, "the example has no cells to take the boundary from"});
        }
        const bool periodic = boundary.kind == BoundaryKind::kPeriodic;
        const bool opposite_periodic =
            parameters.boundary[opposite(side)]->kind == BoundaryKind::kPeriodic;
        if (periodic && !opposite_periodic) {
            faults.push_back(
                {pointer,
                 std::string("periodic needs the opposite side, ") + kSideNames[opposite(side)] +
                     ", to be periodic too"}
            );
        }
    }
}

void find_rule_faults(
    const Constraint& constraint,
    const GridSize& size,
    bool is_region_good,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    if (const auto* count = std::get_if<Count>(&constraint.rule)) {
        if (count->max && *count->max < count->min) {
            faults.push_back({pointer + "/max", "max is less than min"});
        }
        if (count->min > size.cell_count()) {
            faults.push_back({pointer + "/min", "min is more than the model has cells"});
        }
    }
    if (const auto* path = std::get_if<Path>(&constraint.rule)) {
        for (const auto& [name, cell] :
             {std::pair("/from", path->from), std::pair("/to", path->to)}) {
            if (!size.contains(cell)) {
                faults.push_back({pointer + name, "the cell is outside the model"});
            } else if (is_region_good && !RegionCoverage(constraint.region, size).contains(cell)) {
                faults.push_back({pointer + name, "the cell is outside the constraint's region"});
            }
        }
    }
}

void find_symmetry_faults(
    const LabelOfName& labels,
    const Symmetry& symmetry,
    const Region& region,
    const GridSize& size,
    bool is_region_good,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    const std::size_t before = faults.size();
    const NamePairs mirror = symmetry.mirror.value_or(NamePairs());  // what is found is no fault
    for (const auto& [piece, image] : mirror) {
        for (const std::string& name : {piece, image}) {
            if (!labels.contains(name)) {
                faults.push_back(
                    {pointer + "/mirror/" + pointer_part(piece),
                     "the example has no piece \"" + name + "\""}
                );
            }
        }
    }
    if (is_region_good && faults.size() == before) {
        if (const auto fault = find_symmetry_fault(
                symmetry, region, size, labels.size(), pairs_of(labels, mirror)
            )) {
            faults.push_back({pointer + fault->field, fault->detail});
        }
    }
}

void find_term_faults(
    const LabelOfName& labels,
    const std::vector<Term>& terms,
    const Region& region,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    for (std::size_t t = 0; t < terms.size(); ++t) {
        const std::string term = pointer + "/terms/" + std::to_string(t);
        find_unknown_pieces(labels, terms[t].pieces, term + "/pieces", faults);
        if (terms[t].kind == Term::Kind::kShape && region == Region{}) {
            faults.push_back(
                {term + "/term",
                 "a shape is that of the constraint's box, cells, mask or voxels, and it has none"}
            );
        }
    }
}

// What the kinds that weigh whole models ask for.
void find_weighing_faults(
    const LabelOfName& labels,
    const Parameters& parameters,
    const Constraint& constraint,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    if (const auto* objective = std::get_if<Objective>(&constraint.rule)) {
        find_term_faults(labels, objective->terms, constraint.region, pointer, faults);
        if (!*parameters.blocks) {
            faults.push_back(
                {pointer + "/kind",
                 "an objective is weighed block by block, and blocks is null; best_of weighs whole "
                 "models"}
            );
        }
    }
    if (const auto* best = std::get_if<BestOf>(&constraint.rule)) {
        find_term_faults(labels, best->terms, constraint.region, pointer, faults);
    }
}

void find_resemblance_faults(
    const Example& example,
    const Constraint& constraint,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    const auto* resemblance = std::get_if<Resemblance>(&constraint.rule);
    if (resemblance == nullptr) {
        return;
    }
    if (example.size.cell_count() == 0) {
        faults.push_back({pointer + "/kind", "the example has no arrangement to resemble"});
    } else if (resemblance_cost(example, *resemblance) > kResemblanceCostMax) {
        faults.push_back(
            {pointer + "/window",
             "the example's cells times the cells of a window are more than " +
                 std::to_string(kResemblanceCostMax),
             true}
        );
    }
}

void find_constraint_faults(
    const Example& example,
    const LabelOfName& labels,
    const Parameters& parameters,
    std::vector<Fault>& faults
) {
    const GridSize size = *parameters.size;
    std::array<bool, std::variant_size_v<Rule>> is_seen = {};
    for (std::size_t i = 0; i < parameters.constraints.size(); ++i) {
        const Constraint& constraint = parameters.constraints[i];
        const std::string pointer = "/constraints/" + std::to_string(i);
        find_unknown_pieces(labels, constraint.pieces, pointer + "/pieces", faults);
        const std::size_t before = faults.size();
        find_region_faults(constraint.region, size, pointer, faults);
        const bool is_region_good = faults.size() == before;
        find_rule_faults(constraint, size, is_region_good, pointer, faults);
        if (const auto* symmetry = std::get_if<Symmetry>(&constraint.rule)) {
            find_symmetry_faults(
                labels, *symmetry, constraint.region, size, is_region_good, pointer, faults
            );
        }
        find_weighing_faults(labels, parameters, constraint, pointer, faults);
        find_resemblance_faults(example, constraint, pointer, faults);
        const bool is_single = std::holds_alternative<BestOf>(constraint.rule) ||
                               std::holds_alternative<Resemblance>(constraint.rule);
        if (is_single && std::exchange(is_seen.at(constraint.rule.index()), true)) {
            faults.push_back({pointer + "/kind", "there is one of this kind before it"});
        }
    }
}

}  // namespace

void find_region_faults(
    const Region& region,
    const GridSize& size,
    const std::string& pointer,
    std::vector<Fault>& faults
) {
    if (region.box && !(size.contains(region.box->min) && region.box->max.x <= size.x &&
                        region.box->max.y <= size.y && region.box->max.z <= size.z)) {
        faults.push_back({pointer + "/box", "the box reaches beyond the model"});
    }
    for (std::size_t c = 0; c < region.cells.size(); ++c) {
        if (!size.contains(region.cells[c])) {
            faults.push_back(
                {pointer + "/cells/" + std::to_string(c), "the cell is outside the model"}
            );
        }
    }
}

std::vector<Fault> find_faults(const Example& example, const Parameters& parameters) {
    std::vector<Fault> faults;
    const LabelOfName labels = labels_by_name(example);
    find_boundary_faults(example, labels, parameters, faults);
    if (const auto* list = std::get_if<WeightList>(&*parameters.weights)) {
        for (const auto& [name, weight] : *list) {
            if (!labels.contains(name)) {
                faults.push_back(
                    {"/weights/" + pointer_part(name), "the example has no piece \"" + name + "\""}
                );
            }
        }
    }
    find_constraint_faults(example, labels, parameters, faults);
    return faults;
}

}  // namespace modelsynth::discrete
