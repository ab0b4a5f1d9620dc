#pragma once

#include "solver/continuous/arrangement.h"
#include "solver/core/topology.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// The vertices of an arrangement, numbered as there, and after them its edges, as a topology in
// which an edge lies between its two ends: how what stands at them hangs together. Edges that
// leave the box are none of it.
// Cost: 4 bytes an edge's end, 12 an edge. Thread-safe.
class Skeleton {
  public:
    static constexpr std::size_t kRelationCount = 0;

    struct Edge {
        Site from = 0;
        Site to = 0;
        Heading heading = 0;  // from `from`
    };

    // Requires: the arrangement outlives it.
    explicit Skeleton(const Arrangement& arrangement);

    [[nodiscard]] std::size_t vertex_count() const { return first_end_.size() - 1; }

    [[nodiscard]] std::size_t site_count() const { return vertex_count() + edges_.size(); }

    // Requires: a site that is an edge.
    [[nodiscard]] const Edge& edge(Site site) const { return edges_[site - vertex_count()]; }

    // The edges at a vertex, as sites.
    [[nodiscard]] std::span<const Site> edges_at(Site vertex) const {
        return {ends_.data() + first_end_[vertex], first_end_[vertex + 1] - first_end_[vertex]};
    }

    template <class Visit>
    void for_each_arc(Site site, Visit visit) const {
        if (site < vertex_count()) {
            for (const Site edge : edges_at(site)) {
                visit(edge, RelationId{0});
            }
        } else {
            visit(edge(site).from, RelationId{0});
            visit(edge(site).to, RelationId{0});
        }
    }

  private:
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> first_end_;
    std::vector<Site> ends_;
};

}  // namespace modelsynth::continuous
