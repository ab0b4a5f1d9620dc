#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// An undirected graph in rows: the neighbours of node n are neighbours[first[n]] ...
// neighbours[first[n + 1] - 1]. Two nodes may be joined more than once.
struct NodeGraph {
    std::vector<std::uint32_t> first = {0};
    std::vector<std::uint32_t> neighbours;

    [[nodiscard]] std::size_t node_count() const { return first.size() - 1; }

    [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t node) const {
        return std::span(neighbours).subspan(first[node], first[node + 1] - first[node]);
    }
};

enum class NodeRole : std::uint8_t {
    kAbsent,    // as if it were not in the graph
    kOptional,  // may be passed through
    kTerminal,  // what is to hang together
};

// What holds the terminals of a graph together, by one depth-first search (Tarjan 1972).
// Memory is kept from call to call.
class CutNodes {
  public:
    // Looks at the nodes that a terminal reaches.
    // Requires: root is a terminal. Cost: O(nodes + arcs).
    void find(const NodeGraph& graph, std::span<const NodeRole> roles, std::uint32_t root);

    // Whether the root reaches the node.
    [[nodiscard]] bool reached(std::uint32_t node) const { return order_[node] != 0; }

    // Terminals reached, the root included.
    [[nodiscard]] std::uint32_t terminals_reached() const { return terminals_reached_; }

    // The optional nodes without any one of which the root would lose a terminal.
    [[nodiscard]] const std::vector<std::uint32_t>& needed() const { return needed_; }

  private:
    struct Visit {
        std::uint32_t node;
        std::uint32_t next;  // the arc to go along next
    };

    std::vector<std::uint32_t> order_;      // in which nodes were met, from 1; 0: not met
    std::vector<std::uint32_t> lowest_;     // the earliest node that the subtree touches
    std::vector<std::uint32_t> terminals_;  // in the subtree
    std::vector<std::uint8_t> is_needed_;
    std::vector<std::uint32_t> needed_;
    std::vector<Visit> path_;
    std::uint32_t terminals_reached_ = 0;
};

}  // namespace modelsynth
