#pragma once

#include "solver/core/graph_topology.h"
#include "solver/core/relations.h"

#include <cstddef>
#include <numeric>
#include <vector>

namespace modelsynth::testing {

// All of a graph as one part.
inline GraphPart whole_graph(const GraphTopology& graph) {
    std::vector<Site> sites(graph.site_count());
    std::iota(sites.begin(), sites.end(), Site{0});
    return {graph, std::move(sites), {}};
}

// Any two labels may stand side by side that differ.
inline Relations make_colouring(std::size_t colours) {
    Relations relations(colours, {0});  // one symmetric relation: different labels
    for (std::size_t a = 0; a < colours; ++a) {
        for (std::size_t b = 0; b < colours; ++b) {
            if (a != b) {
                relations.allow(0, static_cast<Label>(a), static_cast<Label>(b));
            }
        }
    }
    return relations;
}

}  // namespace modelsynth::testing
