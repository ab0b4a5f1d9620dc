#pragma once

#include "solver/core/constraints/cut_nodes.h"
#include "solver/core/constraints/set_constraint.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {

// A part of a topology and what of the set lies about it, as a graph: a node for each site inside,
// 0 ... inside_count()-1, and one for each piece of the outside that the set holds together and
// that touches the part. Arcs along which a member touches the outside lead to that node.
//
// Outside, members are looked for from the part outwards and no further than it takes to see that
// all pieces are one.
// Cost: four bytes a site of the whole, and O(part) to O(whole) a part.
template <Topology T>
class SurroundingsGraph {
  public:
    // Requires: topology outlives it.
    explicit SurroundingsGraph(const T& topology)
        : topology_(topology), node_of_(topology.site_count(), kNone) {}

    // `anchors`: sites whose node is asked for, inside or not.
    void enter(
        const Members& members, std::span<const Site> inside, std::span<const Site> anchors = {}
    ) {
        for (const Site site : marked_) {
            node_of_[site] = kNone;
        }
        marked_.clear();
        inside_.assign(inside.begin(), inside.end());
        for (std::uint32_t node = 0; node < inside_.size(); ++node) {
            mark(inside_[node], node);
        }
        gather_outside(members, anchors);
        join_arcs();
    }

    [[nodiscard]] const NodeGraph& graph() const { return graph_; }

    [[nodiscard]] std::uint32_t inside_count() const {
        return static_cast<std::uint32_t>(inside_.size());
    }

    [[nodiscard]] Site site(std::uint32_t inside_node) const { return inside_[inside_node]; }

    // Requires: an anchor of enter() that is a member or inside. kNone: it is neither.
    [[nodiscard]] std::uint32_t node_of(Site anchor) const { return node_of_[anchor]; }

    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  private:
    void mark(Site site, std::uint32_t node) {
        node_of_[site] = node;
        marked_.push_back(site);
    }

    // Members outside that touch the part, and how they hang together: every one begins as a piece
    // of its own, and pieces that meet become one.
    void gather_outside(const Members& members, std::span<const Site> anchors) {
        piece_.clear();
        frontier_.clear();
        const auto begin_piece = [&](Site site) {
            if (node_of_[site] == kNone && members.at(site) == Membership::kYes) {
                mark(site, inside_count() + static_cast<std::uint32_t>(piece_.size()));
                piece_.push_back(static_cast<std::uint32_t>(piece_.size()));
                frontier_.push_back(site);
            }
        };
        for (const Site site : inside_) {
            topology_.for_each_arc(site, [&](Site neighbour, RelationId) {
                begin_piece(neighbour);
            });
        }
        for (const Site site : anchors) {
            begin_piece(site);
        }
        std::size_t pieces = piece_.size();
        for (std::size_t i = 0; i < frontier_.size() && pieces > 1; ++i) {
            const std::uint32_t own = node_of_[frontier_[i]];
            topology_.for_each_arc(frontier_[i], [&](Site neighbour, RelationId) {
                if (members.at(neighbour) != Membership::kYes) {
                    return;
                }
                const std::uint32_t other = node_of_[neighbour];
                if (other == kNone) {
                    mark(neighbour, own);
                    frontier_.push_back(neighbour);
                } else if (other >= inside_count() && find(own) != find(other)) {
                    piece_[find(other)] = find(own);
                    --pieces;
                }
            });
        }
        // Pieces are numbered without gaps, by their first site.
        std::vector<std::uint32_t> number(piece_.size(), kNone);
        std::uint32_t next = inside_count();
        for (std::uint32_t piece = 0; piece < piece_.size(); ++piece) {
            std::uint32_t& root = number[find(inside_count() + piece)];
            root = root == kNone ? next++ : root;
        }
        node_count_ = next;
        for (const Site site : std::span(marked_).subspan(inside_.size())) {
            node_of_[site] = number[find(node_of_[site])];
        }
    }

    [[nodiscard]] std::uint32_t find(std::uint32_t node) {
        std::uint32_t piece = node - inside_count();
        while (piece_[piece] != piece) {
            piece_[piece] = piece_[piece_[piece]];
            piece = piece_[piece];
        }
        return piece;
    }

    void join_arcs() {
        graph_.first.assign(1, 0);
        graph_.neighbours.clear();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> outward;  // from outside, from inside
        for (std::uint32_t node = 0; node < inside_.size(); ++node) {
            topology_.for_each_arc(inside_[node], [&](Site neighbour, RelationId) {
                const std::uint32_t other = node_of_[neighbour];
                if (other != kNone) {
                    graph_.neighbours.push_back(other);
                    if (other >= inside_.size()) {
                        outward.emplace_back(other, node);
                    }
                }
            });
            graph_.first.push_back(static_cast<std::uint32_t>(graph_.neighbours.size()));
        }
        std::sort(outward.begin(), outward.end());
        std::size_t at = 0;
        for (std::uint32_t node = inside_count(); node < node_count_; ++node) {
            for (; at < outward.size() && outward[at].first == node; ++at) {
                graph_.neighbours.push_back(outward[at].second);
            }
            graph_.first.push_back(static_cast<std::uint32_t>(graph_.neighbours.size()));
        }
    }

    const T& topology_;
    std::vector<std::uint32_t> node_of_;  // by site of the whole
    std::vector<Site> marked_;            // those that have a node: inside first
    std::vector<Site> inside_;
    std::vector<Site> frontier_;
    std::vector<std::uint32_t> piece_;  // union-find
    std::uint32_t node_count_ = 0;
    NodeGraph graph_;
};

}  // namespace modelsynth
