#pragma once

#include "solver/core/constraints/set_constraint.h"
#include "solver/core/constraints/surroundings_graph.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace modelsynth {

// The members form no ring along the arcs of the topology: a forest.
//
// An undecided site that touches one piece of it twice would close a ring, so it cannot belong.
// Cost: O(part) a call, and what SurroundingsGraph takes.
template <Topology T>
class AcyclicConstraint final : public SetConstraint {
  public:
    // Requires: topology outlives it.
    explicit AcyclicConstraint(const T& topology) : surroundings_(topology) {}

    void enter(const Members& members, std::span<const Site> inside) override {
        surroundings_.enter(members, inside);
    }

    [[nodiscard]] bool conclude(
        const Members& members, std::span<const Site> /*changed*/, Conclusions& conclusions
    ) override {
        const NodeGraph& graph = surroundings_.graph();
        piece_.resize(graph.node_count());
        std::iota(piece_.begin(), piece_.end(), 0U);
        for (std::uint32_t node = 0; node < surroundings_.inside_count(); ++node) {
            if (membership(members, node) != Membership::kYes) {
                continue;
            }
            for (const std::uint32_t other : graph.of(node)) {
                // Arcs inside are seen from both ends; those to the outside from here alone.
                const bool first_seen = other < node || other >= surroundings_.inside_count();
                if (first_seen && membership(members, other) == Membership::kYes &&
                    !join(node, other)) {
                    return false;
                }
            }
        }
        for (std::uint32_t node = 0; node < surroundings_.inside_count(); ++node) {
            if (membership(members, node) == Membership::kMaybe &&
                closes_ring(members, graph, node)) {
                conclusions.never.push_back(surroundings_.site(node));
            }
        }
        return true;
    }

  private:
    [[nodiscard]] Membership membership(const Members& members, std::uint32_t node) const {
        return node < surroundings_.inside_count() ? members.at(surroundings_.site(node))
                                                   : Membership::kYes;
    }

    bool closes_ring(const Members& members, const NodeGraph& graph, std::uint32_t node) {
        touched_.clear();
        for (const std::uint32_t other : graph.of(node)) {
            if (membership(members, other) == Membership::kYes) {
                const std::uint32_t piece = find(other);
                if (std::find(touched_.begin(), touched_.end(), piece) != touched_.end()) {
                    return true;
                }
                touched_.push_back(piece);
            }
        }
        return false;
    }

    std::uint32_t find(std::uint32_t node) {
        while (piece_[node] != node) {
            piece_[node] = piece_[piece_[node]];
            node = piece_[node];
        }
        return node;
    }

    // False: they are of one piece already.
    bool join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t root_a = find(a);
        const std::uint32_t root_b = find(b);
        piece_[root_a] = root_b;
        return root_a != root_b;
    }

    SurroundingsGraph<T> surroundings_;
    std::vector<std::uint32_t> piece_;
    std::vector<std::uint32_t> touched_;
};

}  // namespace modelsynth
