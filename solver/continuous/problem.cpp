#include "solver/continuous/problem.h"

#include "solver/continuous/domains.h"
#include "solver/continuous/initial_model.h"
#include "solver/continuous/model_planes.h"
#include "solver/continuous/object_rules.h"

#include <algorithm>
#include <set>
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

std::vector<Connection> connections_of(
    const ExampleReading& reading, const Parameters& parameters
) {
    std::vector<Connection> connections;
    for (const Constraint& constraint : *parameters.constraints) {
        if (const auto* rule = std::get_if<ConnectedRule>(&constraint.rule)) {
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

}  // namespace

Result<Problem> make_problem(
    std::shared_ptr<const ExampleReading> reading, const Parameters& parameters
) {
    const Topes& topes = reading->topes();
    const Figures& figures = reading->figures();
    ModelPlanes planes = make_planes(*reading, parameters);
    const Arrangement::Frame frame = {
        model_box(*reading, parameters), cells_of(parameters), *parameters.spacing};
    auto arrangement = Arrangement::make(topes, planes.offsets, frame, kVerticesMax);
    if (!arrangement) {
        return tl::unexpected(std::move(arrangement.error()));
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
    auto initial = find_initial_labels(
        symmetries ? symmetries->relations() : reading->relations(),
        *arrangement,
        symmetries.get(),
        domains,
        *weights,
        std::move(plain)
    );
    if (!initial) {
        return tl::unexpected(std::move(initial.error()));
    }
    std::vector<Label> homeless = find_homeless(figures, *arrangement);
    std::vector<Connection> connections = connections_of(*reading, parameters);
    return Problem{
        std::move(reading),
        std::move(planes.spacings),
        std::move(*arrangement),
        std::move(domains),
        std::move(*weights),
        std::move(*initial),
        std::move(homeless),
        std::move(connections),
        std::move(symmetries)};
}

}  // namespace modelsynth::continuous
