#pragma once

#include "solver/core/graph_topology.h"
#include "solver/core/relations.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::testing {

// All of a graph as one part.
inline GraphPart whole_graph(const GraphTopology& graph) {
    std::vector<Site> sites(graph.site_count());
    std::iota(sites.begin(), sites.end(), Site{0});
    return {graph, std::move(sites), {}};
}

// Some sites, in rising order, of a graph of these arcs.
inline GraphPart part_of_graph(std::span<const GraphArc> arcs, std::vector<Site> sites) {
    const auto number_of = [&sites](Site site) {
        const auto found = std::lower_bound(sites.begin(), sites.end(), site);
        return found != sites.end() && *found == site ? static_cast<Site>(found - sites.begin())
                                                      : kNoSite;
    };
    std::vector<GraphArc> inner;
    std::vector<GraphPart::OutwardArc> outward;
    for (const GraphArc& arc : arcs) {
        const Site a = number_of(arc.a);
        const Site b = number_of(arc.b);
        if (a != kNoSite && b != kNoSite) {
            inner.push_back({a, b, arc.from_a, arc.from_b});
        } else if (a != kNoSite) {
            outward.push_back({a, arc.b, arc.from_a});
        } else if (b != kNoSite) {
            outward.push_back({b, arc.a, arc.from_b});
        }
    }
    return {GraphTopology(sites.size(), inner), std::move(sites), std::move(outward)};
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
