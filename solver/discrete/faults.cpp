#include "solver/discrete/faults.h"

#include "solver/discrete/names.h"
#include "solver/discrete/region.h"

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

// A name as part of a JSON Pointer (RFC 6901).
std::string escape_pointer(const std::string& name) {
    std::string escaped;
    for (const char c : name) {
        escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    }
    return escaped;
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

void find_constraint_faults(
    const LabelOfName& labels, const Parameters& parameters, std::vector<Fault>& faults
) {
    const GridSize size = *parameters.size;
    for (std::size_t i = 0; i < parameters.constraints.size(); ++i) {
        const Constraint& constraint = parameters.constraints[i];
        const std::string pointer = "/constraints/" + std::to_string(i);
        find_unknown_pieces(labels, constraint.pieces, pointer + "/pieces", faults);
        const std::size_t before = faults.size();
        find_region_faults(constraint.region, size, pointer, faults);
        find_rule_faults(constraint, size, faults.size() == before, pointer, faults);
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
                    {"/weights/" + escape_pointer(name),
                     "the example has no piece \"" + name + "\""}
                );
            }
        }
    }
    find_constraint_faults(labels, parameters, faults);
    return faults;
}

}  // namespace modelsynth::discrete
