#include "solver/continuous/constraints/connections.h"

#include <algorithm>
#include <utility>

namespace modelsynth::continuous {

Connections::Connections(
    const Figures& figures, const Skeleton& skeleton, std::span<const Connection> connections
)
    : figures_(figures),
      skeleton_(skeleton),
      connections_(connections),
      is_inside_(skeleton.beyond() + std::size_t{1}) {
    for (std::size_t i = 0; i < connections.size(); ++i) {
        states_.push_back(
            {Members(skeleton.site_count()), 0, SurroundingsGraph<Skeleton>(skeleton), 0, {}}
        );
    }
}

void Connections::start(std::span<const Label> model) {
    std::vector<Site> all(skeleton_.site_count());
    for (std::size_t site = 0; site < all.size(); ++site) {
        all[site] = static_cast<Site>(site);
    }
    inside_ = all;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        put(state, connections_[i], model);
        state.surroundings.enter(state.members, inside_);
        state.components = count(state);
    }
}

void Connections::enter(std::span<const Site> part) {
    inside_.assign(part.begin(), part.end());
    for (const Site vertex : part) {
        is_inside_[vertex] = 1;
    }
    for (const Site vertex : part) {
        for (const Site edge : skeleton_.edges_at(vertex)) {
            const Skeleton::Edge& ends = skeleton_.edge(edge);
            if (ends.from == vertex && is_inside_[ends.to] != 0) {
                inside_.push_back(edge);
            }
        }
    }
    for (const Site vertex : part) {
        is_inside_[vertex] = 0;
    }
    for (State& state : states_) {
        state.surroundings.enter(state.members, inside_);
        state.components_before = count(state);
        state.before.clear();
        for (const Site site : inside_) {
            state.before.push_back(state.members.at(site));
        }
    }
}

bool Connections::accepts(std::span<const Label> model) {
    const std::vector<std::uint32_t> after = put_all(model);
    bool accepted = true;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        accepted =
            accepted && after[i] <= std::max(states_[i].components, connections_[i].components);
    }
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        if (accepted) {
            state.components = after[i];
            continue;
        }
        for (std::size_t n = 0; n < inside_.size(); ++n) {
            state.members.set(inside_[n], state.before[n]);
        }
    }
    return accepted;
}

void Connections::take_back(std::span<const Label> model) {
    const std::vector<std::uint32_t> after = put_all(model);
    for (std::size_t i = 0; i < states_.size(); ++i) {
        states_[i].components = after[i];
    }
}

bool Connections::is_all_inside(std::size_t connection) const {
    const State& state = states_[connection];
    const auto inside = static_cast<std::size_t>(
        std::count(state.before.begin(), state.before.end(), Membership::kYes)
    );
    return state.members.count(Membership::kYes) == inside;
}

void Connections::put(State& state, const Connection& connection, std::span<const Label> model) {
    for (const Site site : inside_) {
        state.members.set(site, membership(connection, model, site));
    }
}

// The components there are with it, by connection.
std::vector<std::uint32_t> Connections::put_all(std::span<const Label> model) {
    std::vector<std::uint32_t> after;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        put(state, connections_[i], model);
        after.push_back(state.components - state.components_before + count(state));
    }
    return after;
}

Membership Connections::membership(
    const Connection& connection, std::span<const Label> model, Site site
) const {
    if (site == skeleton_.beyond()) {
        return connection.has_ground ? Membership::kYes : Membership::kNo;
    }
    Label figure = kNoLabel;
    if (!skeleton_.is_edge(site)) {
        figure = model[site];
    } else {
        const Skeleton::Edge& edge = skeleton_.edge(site);
        const Label at_end = model[edge.from];
        figure = at_end == kNoLabel ? kNoLabel : figures_.along(at_end, edge.heading);
    }
    return connection.figures.contains(figure) ? Membership::kYes : Membership::kNo;
}

// Components of what is inside and of the pieces outside that touch it.
std::uint32_t Connections::count(const State& state) {
    const NodeGraph& graph = state.surroundings.graph();
    const std::uint32_t inside = state.surroundings.inside_count();
    is_met_.assign(graph.node_count(), 0);
    std::uint32_t components = 0;
    const auto meet = [&](std::uint32_t node) {
        const bool is_member =
            node >= inside || state.members.at(state.surroundings.site(node)) == Membership::kYes;
        if (is_member && std::exchange(is_met_[node], std::uint8_t{1}) == 0) {
            path_.push_back(node);
            return true;
        }
        return false;
    };
    for (std::uint32_t node = 0; node < graph.node_count(); ++node) {
        components += meet(node) ? 1U : 0U;
        while (!path_.empty()) {
            const std::uint32_t at = path_.back();
            path_.pop_back();
            for (const std::uint32_t neighbour : graph.of(at)) {
                meet(neighbour);
            }
        }
    }
    return components;
}

}  // namespace modelsynth::continuous
