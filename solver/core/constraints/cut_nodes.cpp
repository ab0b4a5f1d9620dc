#include "solver/core/constraints/cut_nodes.h"

#include <algorithm>

namespace modelsynth {

void CutNodes::find(const NodeGraph& graph, std::span<const NodeRole> roles, std::uint32_t root) {
    const std::size_t count = graph.node_count();
    order_.assign(count, 0);
    lowest_.resize(count);
    terminals_.resize(count);
    is_needed_.assign(count, 0);
    needed_.clear();
    std::uint32_t met = 0;
    const auto meet = [&](std::uint32_t node) {
        order_[node] = lowest_[node] = ++met;
        terminals_[node] = roles[node] == NodeRole::kTerminal ? 1 : 0;
        path_.push_back({node, graph.first[node]});
    };
    meet(root);
    while (!path_.empty()) {
        Visit& visit = path_.back();
        const std::uint32_t node = visit.node;
        if (visit.next < graph.first[node + 1]) {
            const std::uint32_t neighbour = graph.neighbours[visit.next++];
            if (roles[neighbour] == NodeRole::kAbsent) {
                continue;
            }
            if (order_[neighbour] == 0) {
                meet(neighbour);
            } else {
                lowest_[node] = std::min(lowest_[node], order_[neighbour]);
            }
            continue;
        }
        path_.pop_back();
        if (path_.empty()) {
            break;
        }
        const std::uint32_t parent = path_.back().node;
        // What hangs on the parent alone reaches no further back than to it.
        if (terminals_[node] > 0 && lowest_[node] >= order_[parent] &&
            roles[parent] == NodeRole::kOptional && is_needed_[parent] == 0) {
            is_needed_[parent] = 1;
            needed_.push_back(parent);
        }
        lowest_[parent] = std::min(lowest_[parent], lowest_[node]);
        terminals_[parent] += terminals_[node];
    }
    terminals_reached_ = terminals_[root];
}

}  // namespace modelsynth
