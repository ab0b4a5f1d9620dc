#pragma once

#include "solver/continuous/planes/arrangement.h"
#include "solver/core/topology.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// The vertices of an arrangement, numbered as there, then what lies beyond its box, as one, and
// after that its edges, as a topology in which an edge lies between its two ends: how what stands
// at them hangs together. Edges that leave the box end beyond it. Cost: 4 bytes an edge's end, 12
// an edge. Thread-safe.
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

    [[nodiscard]] Site beyond() const { return static_cast<Site>(first_end_.size() - 2); }

    [[nodiscard]] std::size_t site_count() const { return beyond() + 1 + edges_.size(); }

    [[nodiscard]] bool is_edge(Site site) const { return site > beyond(); }

    // Requires: a site that is an edge.
    [[nodiscard]] const Edge& edge(Site site) const { return edges_[site - beyond() - 1]; }

    // The edges at a vertex, or those that leave the box, as sites.
    [[nodiscard]] std::span<const Site> edges_at(Site vertex) const {
        return {ends_.data() + first_end_[vertex], first_end_[vertex + 1] - first_end_[vertex]};
    }

    template <class Visit>
    void for_each_arc(Site site, Visit visit) const {
        if (is_edge(site)) {
            visit(edge(site).from, RelationId{0});
            visit(edge(site).to, RelationId{0});
        } else {
            for (const Site edge : edges_at(site)) {
                visit(edge, RelationId{0});
            }
        }
    }

  private:
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> first_end_;
    std::vector<Site> ends_;
};

}  // namespace modelsynth::continuous
