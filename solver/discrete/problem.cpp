#include "solver/discrete/problem.h"

#include "solver/core/weight_tables.h"
#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/faults.h"
#include "solver/discrete/names.h"
#include "solver/discrete/region.h"

#include <algorithm>
#include <utility>

namespace modelsynth::discrete {

namespace {

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

// Fails when some site has no label left before any neighbour was asked.
Result<void> check_domains(const Problem& problem) {
    std::optional<Site> impossible;
    const SiteDomains& domains = problem.domains;
    domains
        .for_each_run(0, domains.site_count(), [&](Site site, std::size_t, std::uint16_t number) {
            if (!impossible && domains.set(number).empty()) {
                impossible = site;
            }
        });
    if (!impossible) {
        return {};
    }
    const Cell cell = problem.size.cell(*impossible);
    const std::string sides = name_sides(problem.size, cell);
    const bool is_kept = problem.start && problem.start->is_kept[*impossible] != 0;
    return tl::unexpected(Error{
        ErrorCode::kContradiction,
        "no piece can stand at cell " + name_cell(cell) + (sides.empty() ? "" : ", on " + sides) +
            (is_kept ? ": the boundary and the constraints forbid what stands there in the "
                       "model that this one starts from"
                     : ": what the boundary and the constraints allow there has nothing in "
                       "common"),
        {}});
}

// The model to start from, in its place; what it keeps is fixed.
void keep_origin(const Origin& origin, Problem& problem) {
    const GridSize& size = problem.size;
    const Box covered = {
        origin.at,
        {origin.at.x + origin.size.x, origin.at.y + origin.size.y, origin.at.z + origin.size.z}};
    check(
        size.contains(origin.at) && covered.max.x <= size.x && covered.max.y <= size.y &&
            covered.max.z <= size.z && origin.labels.size() == origin.size.cell_count(),
        "a model to start from that does not lie in the model to make"
    );
    const RegionCoverage remade(origin.remade, size);
    const bool keeps_all_it_covers = remade.is_everywhere() && covered != Box::whole(size);
    Start start = {
        std::vector<Label>(size.cell_count(), kNoLabel),
        std::vector<std::uint8_t>(size.cell_count())};
    std::size_t next = 0;
    for_each_cell(covered, [&](const Cell& cell) {
        const std::size_t site = size.index(cell);
        const Label label = origin.labels[next++];
        start.labels[site] = label;
        if (keeps_all_it_covers || !remade.contains(cell)) {
            start.is_kept[site] = 1;
        }
    });
    narrow_to_kept(start, problem.domains);
    problem.start = std::move(start);
}

void narrow_to_images(Problem& problem) {
    for (std::size_t site = 0; site < problem.size.cell_count(); ++site) {
        problem.domains.narrow(
            static_cast<Site>(site), problem.symmetries->allowed_at(static_cast<Site>(site))
        );
    }
}

}  // namespace

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

Relations find_transitions(const Example& example) {
    const std::size_t count = example.pieces.size();
    Relations relations(count, {1, 0, 3, 2, 5, 4});
    const GridSize size = example.size;
    // Most pairs of a large example stand in it many times, and a bit is cheap to look at.
    std::vector<bool> is_known(3 * count * count);
    for_each_cell(Box::whole(size), [&](const Cell& cell) {
        for (std::size_t direction = 0; direction < kDirectionCount; direction += 2) {
            const Cell step = kDirectionSteps[direction];
            const Cell next = {cell.x + step.x, cell.y + step.y, cell.z + step.z};
            if (!size.contains(next)) {
                continue;
            }
            const Label a = example.cells[size.index(cell)];
            const Label b = example.cells[size.index(next)];
            const std::size_t pair = (direction / 2 * count + a) * count + b;
            if (!is_known[pair]) {
                is_known[pair] = true;
                relations.allow(static_cast<RelationId>(direction), a, b);
            }
        }
    });
    for (const AdjacentPair& pair : example.adjacency) {
        relations.allow(static_cast<RelationId>(2 * pair.axis), pair.lower, pair.upper);
    }
    return relations;
}

void narrow_to_kept(const Start& start, SiteDomains& domains) {
    for (std::size_t site = 0; site < start.labels.size(); ++site) {
        if (start.is_kept[site] != 0) {
            LabelSet only(domains.at(static_cast<Site>(site)).label_count());
            only.insert(start.labels[site]);
            domains.narrow(static_cast<Site>(site), only);
        }
    }
}

Result<Problem> read_problem(
    const Example& example, const Parameters& parameters, const Origin* origin
) {
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
        SiteWeights(LabelWeights(weights)),
        {},
        nullptr,
        nullptr,
        nullptr,
        std::nullopt,
        parameters.order.axes};
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
    WeightTables tables(size.cell_count(), weights);
    if (auto read = read_constraints(example, parameters, problem, tables); !read) {
        return tl::unexpected(std::move(read.error()));
    }
    problem.weights = std::move(tables).finish();
    if (problem.symmetries != nullptr) {
        narrow_to_images(problem);
    }
    problem.chooser = make_chooser(example, parameters, problem);
    if (origin != nullptr) {
        keep_origin(*origin, problem);
    }
    return problem;
}

Result<Problem> make_problem(
    const Example& example, const Parameters& parameters, const Origin* origin
) {
    auto problem = read_problem(example, parameters, origin);
    if (!problem) {
        return problem;
    }
    if (auto fits = check_domains(*problem); !fits) {
        return tl::unexpected(std::move(fits.error()));
    }
    return problem;
}

}  // namespace modelsynth::discrete
