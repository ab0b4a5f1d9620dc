#include "solver/core/constraints/cut_nodes.h"

#include "solver/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace modelsynth {
namespace {

struct Net {
    NodeGraph graph;
    std::vector<NodeRole> roles;
    std::uint32_t root = 0;
};

Net random_net(std::uint64_t seed) {
    RandomStream random({seed, 0, 0, 7});
    const std::uint32_t count = 2 + random.below(12);
    std::vector<std::vector<std::uint32_t>> rows(count);
    for (std::uint32_t arcs = random.below(2 * count); arcs > 0; --arcs) {
        const std::uint32_t a = random.below(count);
        const std::uint32_t b = random.below(count);
        rows[a].push_back(b);
        rows[b].push_back(a);
    }
    Net net;
    for (const auto& row : rows) {
        net.graph.neighbours.insert(net.graph.neighbours.end(), row.begin(), row.end());
        net.graph.first.push_back(static_cast<std::uint32_t>(net.graph.neighbours.size()));
        net.roles.push_back(static_cast<NodeRole>(random.below(3)));
    }
    net.root = random.below(count);
    net.roles[net.root] = NodeRole::kTerminal;
    return net;
}

// What the root reaches when one node is taken away.
std::vector<bool> reach_without(const Net& net, std::uint32_t missing) {
    std::vector<bool> reached(net.roles.size());
    std::vector<std::uint32_t> open = {net.root};
    reached[net.root] = true;
    while (!open.empty()) {
        const std::uint32_t node = open.back();
        open.pop_back();
        for (const std::uint32_t next : net.graph.of(node)) {
            if (next != missing && net.roles[next] != NodeRole::kAbsent && !reached[next]) {
                reached[next] = true;
                open.push_back(next);
            }
        }
    }
    return reached;
}

TEST(CutNodes, AreThoseWithoutWhichATerminalIsLost) {
    std::size_t needed_nodes = 0;
    CutNodes cut;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        const Net net = random_net(seed);
        cut.find(net.graph, net.roles, net.root);
        const auto nobody = static_cast<std::uint32_t>(net.roles.size());
        const std::vector<bool> all = reach_without(net, nobody);
        std::uint32_t terminals = 0;
        for (std::uint32_t node = 0; node < net.roles.size(); ++node) {
            ASSERT_EQ(cut.reached(node), all[node]) << "seed " << seed;
            terminals += all[node] && net.roles[node] == NodeRole::kTerminal ? 1U : 0U;
            bool is_needed = false;
            if (net.roles[node] == NodeRole::kOptional) {
                const std::vector<bool> rest = reach_without(net, node);
                for (std::uint32_t other = 0; other < net.roles.size(); ++other) {
                    is_needed = is_needed || (all[other] && !rest[other] &&
                                              net.roles[other] == NodeRole::kTerminal);
                }
            }
            const auto& needed = cut.needed();
            ASSERT_EQ(std::count(needed.begin(), needed.end(), node), is_needed ? 1 : 0)
                << "seed " << seed << " node " << node;
            needed_nodes += is_needed ? 1 : 0;
        }
        ASSERT_EQ(cut.terminals_reached(), terminals) << "seed " << seed;
    }
    EXPECT_GT(needed_nodes, 300U);
}

}  // namespace
}  // namespace modelsynth
