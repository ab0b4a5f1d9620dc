#include "solver/continuous/constraints/connections.h"

#include "solver/core/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace modelsynth::continuous {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

}  // namespace

Connections::Connections(
    const Figures& figures, const Skeleton& skeleton, std::span<const Connection> connections
)
    : figures_(figures),
      skeleton_(skeleton),
      connections_(connections),
      leaves_box_(skeleton.beyond()),
      is_in_part_(skeleton.beyond() + std::size_t{1}),
      node_of_(skeleton.site_count(), kNone) {
    for (const Site edge : skeleton.edges_at(skeleton.beyond())) {
        leaves_box_[skeleton.edge(edge).from] = 1;
    }
    for (const Connection& connection : connections) {
        State& state = states_.emplace_back(skeleton.site_count());
        if (connection.has_ground) {
            state.members.set(skeleton.beyond(), Membership::kYes);
        }
    }
}

void Connections::start(std::span<const Label> model) {
    std::vector<Site> all(skeleton_.beyond());
    std::iota(all.begin(), all.end(), Site{0});
    enter(all);
    for (std::size_t i = 0; i < states_.size(); ++i) {
        put(states_[i], connections_[i], model);
        states_[i].components = count(states_[i]);
    }
}

void Connections::enter(std::span<const Site> part) {
    for (const Site vertex : part_) {
        is_in_part_[vertex] = 0;
    }
    part_.assign(part.begin(), part.end());
    for (const Site vertex : part_) {
        is_in_part_[vertex] = 1;
    }
    for (State& state : states_) {
        state.before.clear();
        for (const Site vertex : part_) {
            if (state.members.at(vertex) == Membership::kYes) {
                state.before.push_back(vertex);
            }
        }
        const std::size_t vertices = state.before.size();
        for (std::size_t i = 0; i < vertices; ++i) {
            const Site vertex = state.before[i];
            for (const Site edge : skeleton_.edges_at(vertex)) {
                if (skeleton_.edge(edge).from == vertex && is_inside(edge) &&
                    state.members.at(edge) == Membership::kYes) {
                    state.before.push_back(edge);
                }
            }
        }
        state.inside = state.before;
        gather(state);
        state.components_before = count(state);
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
        take_out(state);
        state.inside = state.before;
        for (const Site site : state.inside) {
            state.members.set(site, Membership::kYes);
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
    return state.members.count(Membership::kYes) == state.before.size();
}

bool Connections::is_inside(Site site) const {
    if (!skeleton_.is_edge(site)) {
        return is_in_part_[site] != 0;
    }
    const Skeleton::Edge& edge = skeleton_.edge(site);
    return is_in_part_[edge.from] != 0 &&
           (is_in_part_[edge.to] != 0 || edge.to == skeleton_.beyond());
}

void Connections::take_out(State& state) const {
    for (const Site site : state.inside) {
        state.members.set(site, Membership::kNo);
    }
    state.inside.clear();
}

void Connections::put(State& state, const Connection& connection, std::span<const Label> model)
    const {
    take_out(state);
    const auto is_member = [&](Label figure) {
        return figure != kNoLabel && connection.figures.contains(figure);
    };
    for (const Site vertex : part_) {
        if (is_member(model[vertex])) {
            state.inside.push_back(vertex);
        }
    }
    const std::size_t vertices = state.inside.size();
    for (std::size_t i = 0; i < vertices; ++i) {
        const Site vertex = state.inside[i];
        for (const Site site : skeleton_.edges_at(vertex)) {
            const Skeleton::Edge& edge = skeleton_.edge(site);
            if (edge.from == vertex && is_inside(site) &&
                is_member(figures_.along(model[vertex], edge.heading))) {
                state.inside.push_back(site);
            }
        }
    }
    for (const Site site : state.inside) {
        state.members.set(site, Membership::kYes);
    }
}

// The pieces of the outside that the members there hold together and that touch the part. What
// touches it touches a member of it, as the figures at both ends of an edge agree on the edge.
void Connections::gather(State& state) {
    std::vector<Site>& around = state.around;
    around.clear();
    const auto begin_piece = [&](Site site) {
        if (node_of_[site] == kNone && state.members.at(site) == Membership::kYes) {
            node_of_[site] = static_cast<std::uint32_t>(around.size());
            around.push_back(site);
        }
    };
    for (const Site site : state.inside) {
        skeleton_.for_each_arc(site, [&](Site neighbour, RelationId) {
            if (!is_inside(neighbour)) {
                begin_piece(neighbour);
            }
        });
    }
    const bool is_at_border = std::any_of(part_.begin(), part_.end(), [&](Site vertex) {
        return leaves_box_[vertex] != 0;
    });
    if (is_at_border) {  // an edge there may become a member only later
        begin_piece(skeleton_.beyond());
    }
    const std::size_t touching = around.size();
    DisjointSets pieces(touching);
    std::size_t count = touching;
    for (std::size_t i = 0; i < around.size() && count > 1; ++i) {
        const std::uint32_t own = node_of_[around[i]];
        skeleton_.for_each_arc(around[i], [&](Site neighbour, RelationId) {
            if (state.members.at(neighbour) != Membership::kYes || is_inside(neighbour)) {
                return;
            }
            const std::uint32_t other = node_of_[neighbour];
            if (other == kNone) {
                node_of_[neighbour] = own;
                around.push_back(neighbour);
            } else if (pieces.find(own) != pieces.find(other)) {
                pieces.join(own, other);
                --count;
            }
        });
    }
    for (const Site site : around) {
        node_of_[site] = kNone;
    }
    around.resize(touching);
    // Pieces are numbered without gaps.
    state.piece_of.assign(touching, kNone);
    state.piece_count = 0;
    for (std::uint32_t i = 0; i < touching; ++i) {
        const std::uint32_t least = pieces.find(i);
        state.piece_of[i] = least == i ? state.piece_count++ : state.piece_of[least];
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

// Components of what is inside and of the pieces outside that touch the part.
std::uint32_t Connections::count(const State& state) {
    const auto inside = static_cast<std::uint32_t>(state.inside.size());
    for (std::uint32_t node = 0; node < inside; ++node) {
        node_of_[state.inside[node]] = node;
    }
    for (std::size_t i = 0; i < state.around.size(); ++i) {
        node_of_[state.around[i]] = inside + state.piece_of[i];
    }
    std::uint32_t components = inside + state.piece_count;
    DisjointSets sets(components);
    for (std::uint32_t node = 0; node < inside; ++node) {
        skeleton_.for_each_arc(state.inside[node], [&](Site neighbour, RelationId) {
            const std::uint32_t other = node_of_[neighbour];
            if (other != kNone && sets.find(node) != sets.find(other)) {
                sets.join(node, other);
                --components;
            }
        });
    }
    for (const std::span<const Site> sites : {std::span(state.inside), std::span(state.around)}) {
        for (const Site site : sites) {
            node_of_[site] = kNone;
        }
    }
    return components;
}

}  // namespace modelsynth::continuous
