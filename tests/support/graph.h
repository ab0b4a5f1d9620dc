#pragma once

#include "solver/core/relations.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <vector>

namespace modelsynth::testing {

// A general graph, as other solvers have: arcs listed per site, any relations.
class GraphTopology {
  public:
    static constexpr std::size_t kRelationCount = 0;

    explicit GraphTopology(std::size_t site_count) : arcs_(site_count) {}

    void join(Site a, Site b, RelationId from_a, RelationId from_b) {
        arcs_[a].push_back({b, from_a});
        arcs_[b].push_back({a, from_b});
    }

    [[nodiscard]] std::size_t site_count() const { return arcs_.size(); }

    template <class Visit>
    void for_each_arc(Site site, Visit visit) const {
        for (const auto& [to, relation] : arcs_[site]) {
            visit(to, relation);
        }
    }

    friend bool operator==(const GraphTopology&, const GraphTopology&) = default;

  private:
    struct Arc {
        Site to;
        RelationId relation;

        friend bool operator==(const Arc&, const Arc&) = default;
    };

    std::vector<std::vector<Arc>> arcs_;
};

// All of a graph as one part.
class WholeGraph {
  public:
    using Inner = GraphTopology;

    explicit WholeGraph(const GraphTopology& graph) : graph_(graph) {}

    [[nodiscard]] const GraphTopology& inner() const { return graph_; }

    [[nodiscard]] Site global(Site site) const { return site; }

    template <class Visit>
    void for_each_site(Visit visit) const {
        for (Site site = 0; site < graph_.site_count(); ++site) {
            visit(site, site);
        }
    }

    template <class Visit>
    void for_each_outward_arc(Visit /*visit*/) const {}

  private:
    const GraphTopology& graph_;
};

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
