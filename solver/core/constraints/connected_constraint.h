#pragma once

#include "solver/core/constraints/cut_nodes.h"
#include "solver/core/constraints/set_constraint.h"
#include "solver/core/constraints/surroundings_graph.h"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth {

// The members hang together along the arcs of the topology: all of them, or two given sites (then
// both are members, and others may lie apart).
//
// Undecided sites that members cannot do without - articulation points between them - must belong
// to the set, and those that members cannot reach must not: the way of DeBroglie
// (github.com/BorisTheBrave/DeBroglie).
// Cost: O(part) a call, and what SurroundingsGraph takes.
template <Topology T>
class ConnectedConstraint final : public SetConstraint {
  public:
    // Requires: topology outlives it.
    explicit ConnectedConstraint(const T& topology) : surroundings_(topology) {}

    ConnectedConstraint(const T& topology, Site from, Site to)
        : surroundings_(topology), ends_({from, to}) {}

    void enter(const Members& members, std::span<const Site> inside) override {
        surroundings_.enter(members, inside, ends_);
        std::size_t decided_inside = 0;
        for (const Site site : inside) {
            decided_inside += members.at(site) == Membership::kYes ? 1U : 0U;
        }
        has_outside_ = members.count(Membership::kYes) > decided_inside;
        roles_.resize(surroundings_.graph().node_count());
    }

    [[nodiscard]] bool conclude(
        const Members& members, std::span<const Site> /*changed*/, Conclusions& conclusions
    ) override {
        return ends_.empty() ? conclude_all(members, conclusions)
                             : conclude_ends(members, conclusions);
    }

  private:
    // Every member is a terminal.
    bool conclude_all(const Members& members, Conclusions& conclusions) {
        set_roles(members, NodeRole::kTerminal);
        std::uint32_t terminals = 0;
        std::uint32_t root = 0;
        for (std::uint32_t node = 0; node < roles_.size(); ++node) {
            if (roles_[node] == NodeRole::kTerminal) {
                root = node;
                ++terminals;
            }
        }
        if (terminals == 0) {
            if (has_outside_) {
                // The set lies elsewhere, and nothing here reaches it.
                ban_unless(members, conclusions, [](std::uint32_t) { return false; });
            }
            return true;
        }
        const bool is_apart =
            has_outside_ && roles_.size() == surroundings_.inside_count();  // touched by no piece
        if (is_apart) {
            return false;
        }
        cut_.find(surroundings_.graph(), roles_, root);
        if (cut_.terminals_reached() < terminals) {
            return false;
        }
        require_needed(conclusions);
        ban_unless(members, conclusions, [this](std::uint32_t node) { return cut_.reached(node); });
        return true;
    }

    bool conclude_ends(const Members& members, Conclusions& conclusions) {
        const std::uint32_t from = surroundings_.node_of(ends_[0]);
        const std::uint32_t to = surroundings_.node_of(ends_[1]);
        if (from == SurroundingsGraph<T>::kNone || to == SurroundingsGraph<T>::kNone) {
            return false;
        }
        set_roles(members, NodeRole::kOptional);
        if (roles_[from] == NodeRole::kAbsent || roles_[to] == NodeRole::kAbsent) {
            return false;
        }
        for (const std::uint32_t end : {from, to}) {
            if (is_undecided(members, end) && roles_[end] != NodeRole::kTerminal) {
                conclusions.always.push_back(surroundings_.site(end));
            }
            roles_[end] = NodeRole::kTerminal;
        }
        cut_.find(surroundings_.graph(), roles_, from);
        if (!cut_.reached(to)) {
            return false;
        }
        require_needed(conclusions, &members);
        return true;
    }

    void set_roles(const Members& members, NodeRole of_members) {
        for (std::uint32_t node = 0; node < roles_.size(); ++node) {
            if (node >= surroundings_.inside_count()) {
                roles_[node] = of_members;
                continue;
            }
            const Membership membership = members.at(surroundings_.site(node));
            roles_[node] = membership == Membership::kNo      ? NodeRole::kAbsent
                           : membership == Membership::kMaybe ? NodeRole::kOptional
                                                              : of_members;
        }
    }

    [[nodiscard]] bool is_undecided(const Members& members, std::uint32_t node) const {
        return node < surroundings_.inside_count() &&
               members.at(surroundings_.site(node)) == Membership::kMaybe;
    }

    // What is needed is optional, and so undecided unless members are optional too.
    void require_needed(Conclusions& conclusions, const Members* members = nullptr) {
        for (const std::uint32_t node : cut_.needed()) {
            if (members == nullptr || is_undecided(*members, node)) {
                conclusions.always.push_back(surroundings_.site(node));
            }
        }
    }

    template <class Predicate>
    void ban_unless(const Members& members, Conclusions& conclusions, Predicate reached) {
        for (std::uint32_t node = 0; node < surroundings_.inside_count(); ++node) {
            if (is_undecided(members, node) && !reached(node)) {
                conclusions.never.push_back(surroundings_.site(node));
            }
        }
    }

    SurroundingsGraph<T> surroundings_;
    std::vector<Site> ends_;  // none, or two
    bool has_outside_ = false;
    std::vector<NodeRole> roles_;
    CutNodes cut_;
};

}  // namespace modelsynth
