#include "solver/discrete/problem.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace modelsynth::discrete {

namespace {

using LabelOfName = std::unordered_map<std::string, Label>;

LabelOfName labels_by_name(const Example& example) {
    LabelOfName labels;
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        labels.emplace(example.pieces[label].name, static_cast<Label>(label));
    }
    return labels;
}

// The outermost layer of a grid on one side.
Box layer(const GridSize& size, std::size_t side) {
    Box box = Box::whole(size);
    switch (static_cast<Direction>(side)) {
        case Direction::kEast:
            box.min.x = size.x - 1;
            break;
        case Direction::kWest:
            box.max.x = 1;
            break;
        case Direction::kUp:
            box.min.y = size.y - 1;
            break;
        case Direction::kDown:
            box.max.y = 1;
            break;
        case Direction::kSouth:
            box.min.z = size.z - 1;
            break;
        case Direction::kNorth:
            box.max.z = 1;
            break;
    }
    return box;
}

std::size_t opposite(std::size_t side) { return side ^ 1U; }

// What the side's boundary lets stand in its layer; free sides let everything.
LabelSet allowed_on_side(
    const Example& example,
    const LabelOfName& labels,
    std::size_t side,
    const SideBoundary& boundary
) {
    const std::size_t count = example.pieces.size();
    if (boundary.kind == BoundaryKind::kPieces) {
        LabelSet set(count);
        for (const std::string& name : boundary.pieces) {
            set.insert(labels.at(name));
        }
        return set;
    }
    if (boundary.kind == BoundaryKind::kExample && example.size.cell_count() > 0) {
        LabelSet set(count);
        for_each_cell(layer(example.size, side), [&](const Cell& cell) {
            set.insert(example.cells[example.size.index(cell)]);
        });
        return set;
    }
    return LabelSet::all(count);
}

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

void find_constraint_faults(
    const LabelOfName& labels, const Parameters& parameters, std::vector<Fault>& faults
) {
    const GridSize size = *parameters.size;
    for (std::size_t i = 0; i < parameters.constraints.size(); ++i) {
        const Constraint& constraint = parameters.constraints[i];
        const std::string pointer = "/constraints/" + std::to_string(i);
        find_unknown_pieces(labels, constraint.pieces, pointer + "/pieces", faults);
        if (constraint.box &&
            !(size.contains(constraint.box->min) && constraint.box->max.x <= size.x &&
              constraint.box->max.y <= size.y && constraint.box->max.z <= size.z)) {
            faults.push_back({pointer + "/box", "the box reaches beyond the model"});
        }
        for (std::size_t c = 0; c < constraint.cells.size(); ++c) {
            if (!size.contains(constraint.cells[c])) {
                faults.push_back(
                    {pointer + "/cells/" + std::to_string(c), "the cell is outside the model"}
                );
            }
        }
    }
}

std::vector<double> weights_of(const Example& example, const Weights& weights) {
    const std::size_t count = example.pieces.size();
    std::vector<double> values(count, 1.0);
    if (const auto* list = std::get_if<WeightList>(&weights)) {
        const LabelOfName labels = labels_by_name(example);
        for (const auto& [name, weight] : *list) {
            values[labels.at(name)] = weight;
        }
        return values;
    }
    if (std::get<WeightRule>(weights) == WeightRule::kUniform) {
        for (std::size_t label = 0; label < count; ++label) {
            values[label] = example.pieces[label].weight;
        }
        return values;
    }
    std::fill(values.begin(), values.end(), 0.0);
    for (const Label label : example.cells) {
        values[label] += example.pieces[label].weight;
    }
    // A piece known only from `adjacency` counts as standing once.
    for (const AdjacentPair& pair : example.adjacency) {
        for (const Label label : {pair.lower, pair.upper}) {
            if (values[label] <= 0) {
                values[label] = example.pieces[label].weight;
            }
        }
    }
    return values;
}

// The labels that may be used at all: those that stand somewhere, less those of weight 0.
LabelSet usable_labels(const Example& example, const std::vector<double>& weights) {
    LabelSet used(example.pieces.size());
    for (const Label label : example.cells) {
        used.insert(label);
    }
    for (const AdjacentPair& pair : example.adjacency) {
        used.insert(pair.lower);
        used.insert(pair.upper);
    }
    for (std::size_t label = 0; label < weights.size(); ++label) {
        if (weights[label] <= 0) {
            used.erase(static_cast<Label>(label));
        }
    }
    return used;
}

LabelSet set_of(
    const Example& example, const LabelOfName& labels, const std::vector<std::string>& names
) {
    LabelSet set(example.pieces.size());
    for (const std::string& name : names) {
        set.insert(labels.at(name));
    }
    return set;
}

LabelSet complement(const LabelSet& set) {
    LabelSet rest = LabelSet::all(set.label_count());
    for_each_label(set.words(), [&rest](Label label) { rest.erase(label); });
    return rest;
}

void apply_constraint(
    const Example& example,
    const LabelOfName& labels,
    const Constraint& constraint,
    const GridSize& size,
    SiteDomains& domains
) {
    const LabelSet named = set_of(example, labels, constraint.pieces);
    const LabelSet allowed = constraint.kind == ConstraintKind::kFixed ? named : complement(named);
    const auto apply = [&](const Cell& cell) {
        domains.narrow(static_cast<Site>(size.index(cell)), allowed);
    };
    if (constraint.box) {
        for_each_cell(*constraint.box, apply);
    }
    for (const Cell& cell : constraint.cells) {
        apply(cell);
    }
    if (!constraint.box && constraint.cells.empty()) {
        for_each_cell(Box::whole(size), apply);
    }
}

std::string join_words(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        text += i == 0 ? "" : i + 1 == words.size() ? " and " : ", ";
        text += words[i];
    }
    return text;
}

// Fails when some site has no label left before any neighbour was asked.
Result<void> check_domains(const SiteDomains& domains, const GridSize& size) {
    for (std::size_t site = 0; site < domains.site_count(); ++site) {
        if (!domains.at(static_cast<Site>(site)).empty()) {
            continue;
        }
        const Cell cell = size.cell(site);
        const std::string sides = name_sides(size, cell);
        return tl::unexpected(Error{
            ErrorCode::kContradiction,
            "no piece can stand at cell [" + std::to_string(cell.x) + ", " +
                std::to_string(cell.y) + ", " + std::to_string(cell.z) + "]" +
                (sides.empty() ? "" : ", on " + sides) +
                ": what the boundary and the constraints allow there has nothing in common",
            {}});
    }
    return {};
}

}  // namespace

Relations find_transitions(const Example& example) {
    Relations relations(example.pieces.size(), {1, 0, 3, 2, 5, 4});
    const GridSize size = example.size;
    for_each_cell(Box::whole(size), [&](const Cell& cell) {
        for (std::size_t direction = 0; direction < kDirectionCount; direction += 2) {
            const Cell step = kDirectionSteps[direction];
            const Cell next = {cell.x + step.x, cell.y + step.y, cell.z + step.z};
            if (size.contains(next)) {
                relations.allow(
                    static_cast<RelationId>(direction),
                    example.cells[size.index(cell)],
                    example.cells[size.index(next)]
                );
            }
        }
    });
    for (const AdjacentPair& pair : example.adjacency) {
        relations.allow(static_cast<RelationId>(2 * pair.axis), pair.lower, pair.upper);
    }
    return relations;
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

Result<Problem> make_problem(const Example& example, const Parameters& parameters) {
    check(find_faults(example, parameters).empty(), "a problem was made of faulty parameters");
    const GridSize size = *parameters.size;
    const auto is_periodic = [&parameters](Direction side) {
        return parameters.boundary[static_cast<std::size_t>(side)]->kind == BoundaryKind::kPeriodic;
    };
    const std::vector<double> weights = weights_of(example, *parameters.weights);
    Problem problem = {
        size,
        {is_periodic(Direction::kEast),
         is_periodic(Direction::kUp),
         is_periodic(Direction::kSouth)},
        find_transitions(example),
        SiteDomains(size.cell_count(), usable_labels(example, weights)),
        LabelWeights(weights)};
    const LabelOfName labels = labels_by_name(example);
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const SideBoundary& boundary = *parameters.boundary[side];
        if (boundary.kind == BoundaryKind::kFree || boundary.kind == BoundaryKind::kPeriodic) {
            continue;
        }
        const LabelSet allowed = allowed_on_side(example, labels, side, boundary);
        for_each_cell(layer(size, side), [&](const Cell& cell) {
            problem.domains.narrow(static_cast<Site>(size.index(cell)), allowed);
        });
    }
    for (const Constraint& constraint : parameters.constraints) {
        apply_constraint(example, labels, constraint, size, problem.domains);
    }
    if (auto fits = check_domains(problem.domains, size); !fits) {
        return tl::unexpected(std::move(fits.error()));
    }
    return problem;
}

std::string list_names(const Example& example, const LabelSet& labels) {
    constexpr std::size_t kMost = 8;
    std::vector<std::string> names;
    const std::size_t count = labels.count();
    for_each_label(labels.words(), [&](Label label) {
        if (names.size() < kMost) {
            names.push_back("\"" + example.pieces[label].name + "\"");
        }
    });
    if (count > kMost) {
        names.push_back(std::to_string(count - kMost) + " more");
    }
    return join_words(names);
}

std::string name_sides(const GridSize& size, const Cell& cell) {
    std::vector<std::string> names;
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        if (layer(size, side).contains(cell)) {
            names.emplace_back(kSideNames[side]);
        }
    }
    if (names.empty()) {
        return "";
    }
    return "the " + join_words(names) + (names.size() == 1 ? " side" : " sides");
}

}  // namespace modelsynth::discrete
