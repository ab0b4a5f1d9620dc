#include "solver/continuous/problem.h"

#include "solver/continuous/constraints/object_rules.h"
#include "solver/continuous/domains.h"
#include "solver/continuous/graph_part.h"
#include "solver/continuous/initial_model.h"
#include "solver/continuous/planes/model_planes.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace modelsynth::continuous {

namespace {

// Figures that no vertex of the arrangement has planes for.
std::vector<Label> find_homeless(const Figures& figures, const Arrangement& arrangement) {
    std::set<FamilySet> types;
    for (std::size_t site = 0; site < arrangement.vertex_count(); ++site) {
        types.insert(arrangement.families(static_cast<Site>(site)));
    }
    std::vector<Label> homeless;
    for (std::size_t l = 0; l < figures.count(); ++l) {
        const FamilySet relevant = figures.relevant(static_cast<Label>(l));
        const bool has_place = std::any_of(types.begin(), types.end(), [&](FamilySet families) {
            return (relevant & ~families) == 0;
        });
        if (!has_place) {
            homeless.push_back(static_cast<Label>(l));
        }
    }
    return homeless;
}

// By object, the families across which it has a dimension.
std::vector<FamilySet> stiff_families(const ExampleReading& reading, const Parameters& parameters) {
    const Example& example = reading.example();
    std::vector<FamilySet> stiff(example.objects.size() + 1);
    for (const Constraint& constraint : *parameters.constraints) {
        const auto* rule = std::get_if<DimensionRule>(&constraint.rule);
        if (rule == nullptr) {
            continue;
        }
        const ObjectSet named = objects_named(example, constraint.objects);
        const auto& [x, y, z] = rule->normal;
        for (std::size_t object = 1; object < stiff.size(); ++object) {
            if (named[object]) {
                const Eigen::Matrix3d& turn = example.objects[object - 1].turn;
                stiff[object] |= only(*reading.find_family(turn * Point(x, y, z)));
            }
        }
    }
    return stiff;
}

std::vector<Connection> connections_of(
    const ExampleReading& reading, const Parameters& parameters
) {
    std::vector<Connection> connections;
    for (const Constraint& constraint : *parameters.constraints) {
        const auto* rule = std::get_if<ConnectedRule>(&constraint.rule);
        if (rule != nullptr && !constraint.objects.empty()) {
            const ObjectSet objects = objects_named(reading.example(), constraint.objects);
            const auto ground = reading.example().ground;
            connections.push_back(
                {figures_of(reading.figures(), objects),
                 rule->components,
                 ground && objects[*ground]}
            );
        }
    }
    return connections;
}

std::unique_ptr<const Symmetries> symmetries_of(
    const ExampleReading& reading, const Parameters& parameters, const Arrangement& arrangement
) {
    std::vector<SymmetryRule> rules;
    for (const Constraint& constraint : *parameters.constraints) {
        if (const auto* rule = std::get_if<SymmetryRule>(&constraint.rule)) {
            rules.push_back(*rule);
        }
    }
    return rules.empty()
               ? nullptr
               : std::make_unique<const Symmetries>(reading, arrangement, rules, *parameters.size);
}

bool fit_along_edges(
    const Relations& relations, const Arrangement& arrangement, std::span<const Label> labels
) {
    for (std::size_t v = 0; v < labels.size(); ++v) {
        for (const ArrangementEdge& edge : arrangement.edges(static_cast<Site>(v))) {
            if (edge.end != kNoSite &&
                !relations.allows(edge.heading, labels[v], labels[edge.end])) {
                return false;
            }
        }
    }
    return true;
}

void narrow_to_kept(
    std::span<const Label> labels,
    std::span<const std::uint8_t> is_kept,
    std::size_t label_count,
    SiteDomains& domains
) {
    std::map<std::pair<Label, std::uint16_t>, Site> known;  // by label and domain
    for (std::size_t v = 0; v < labels.size(); ++v) {
        if (is_kept[v] == 0) {
            continue;
        }
        const auto site = static_cast<Site>(v);
        const auto [like, is_new] = known.try_emplace({labels[v], domains.number(site)}, site);
        if (is_new) {
            LabelSet own(label_count);
            own.insert(labels[v]);
            domains.narrow(site, own);
        } else {
            domains.repeat(site, like->second);
        }
    }
}

// Some vertices of the kinds that most of a model has.
GraphPart middle_of(const Arrangement& arrangement, const Symmetries* symmetries) {
    const Box box = Box::middle(arrangement.frame().cells, {4, 4, 4});
    std::vector<Site> vertices;
    arrangement.for_each_vertex(box, [&](Site site) { vertices.push_back(site); });
    return part_of(arrangement, std::move(vertices), symmetries);
}

}  // namespace

Result<Problem> make_problem(
    std::shared_ptr<const ExampleReading> reading,
    const Parameters& parameters,
    const Origin* origin,
    const std::stop_token& stop
) {
    const Topes& topes = reading->topes();
    const Figures& figures = reading->figures();
    ModelPlanes planes = make_planes(*reading, parameters);
    const Arrangement::Frame frame = {
        arranged_box(*reading, parameters), cells_of(parameters), *parameters.spacing};
    auto arrangement = Arrangement::make(topes, planes.offsets, frame, kVerticesMax, stop);
    if (!arrangement) {
        return tl::unexpected(std::move(arrangement.error()));
    }
    if (stop.stop_requested()) {
        return tl::unexpected(cancelled());
    }
    auto weights = make_weights(*reading, parameters, *arrangement);
    if (!weights) {
        return tl::unexpected(std::move(weights.error()));
    }
    std::vector<Label> plain = plain_labels(*reading, *arrangement);
    SiteDomains domains = make_domains(*reading, parameters, *arrangement, planes, plain);
    auto symmetries = symmetries_of(*reading, parameters, *arrangement);
    if (symmetries) {
        symmetries->narrow(domains);
    }
    if (stop.stop_requested()) {
        return tl::unexpected(cancelled());
    }
    std::vector<Label> begun = std::move(plain);
    std::vector<std::uint8_t> is_kept;
    if (origin != nullptr) {
        auto start = place_origin(*reading, parameters, *arrangement, *origin, stop);
        if (!start) {
            return tl::unexpected(std::move(start.error()));
        }
        for (std::size_t v = 0; v < begun.size(); ++v) {
            begun[v] = start->labels[v] == kNoLabel ? begun[v] : start->labels[v];
        }
        if (!fit_along_edges(reading->relations(), *arrangement, begun)) {
            return tl::unexpected(Error{
                ErrorCode::kInternal, "the model to start from does not fit itself", {}});
        }
        is_kept = std::move(start->is_kept);
        narrow_to_kept(begun, is_kept, figures.count(), domains);
    }
    auto initial = find_initial_labels(
        symmetries ? symmetries->relations() : reading->relations(),
        *arrangement,
        symmetries.get(),
        domains,
        *weights,
        std::move(begun),
        stop
    );
    if (!initial) {
        return tl::unexpected(std::move(initial.error()));
    }
    auto by_kind = KindRelations::make(
        symmetries ? symmetries->relations() : reading->relations(),
        domains,
        *weights,
        middle_of(*arrangement, symmetries.get())
    );
    std::vector<Label> homeless = find_homeless(figures, *arrangement);
    std::vector<Connection> connections = connections_of(*reading, parameters);
    const double perturbation =
        parameters.perturbation > 0 ? parameters.perturbation * arrangement->least_distance() : 0;
    const Bounds box = model_box(*reading, parameters);
    std::vector<FamilySet> stiff = stiff_families(*reading, parameters);
    return Problem{
        std::move(reading),
        std::move(planes.spacings),
        box,
        std::move(*arrangement),
        std::move(domains),
        std::move(*weights),
        std::move(by_kind),
        std::move(*initial),
        std::move(is_kept),
        std::move(homeless),
        std::move(connections),
        std::move(symmetries),
        perturbation,
        std::move(stiff)};
}

}  // namespace modelsynth::continuous
