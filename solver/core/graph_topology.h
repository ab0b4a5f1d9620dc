#pragma once

#include "solver/core/relations.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {

// An arc of a general graph: its two ends, and the relation as seen from each.
struct GraphArc {
    Site a = 0;
    Site b = 0;
    RelationId from_a = 0;
    RelationId from_b = 0;

    friend bool operator==(const GraphArc&, const GraphArc&) = default;
};

// Sites joined by any arcs, several between the same two if need be.
// Cost: 16 bytes an arc, 4 a site. Thread-safe.
class GraphTopology {
  public:
    static constexpr std::size_t kRelationCount = 0;

    // Requires: every end is below site_count (checked).
    GraphTopology(std::size_t site_count, std::span<const GraphArc> arcs);

    [[nodiscard]] std::size_t site_count() const { return first_end_.size() - 1; }

    template <class Visit>
    void for_each_arc(Site site, Visit visit) const {
        for (std::size_t i = first_end_[site]; i < first_end_[site + 1]; ++i) {
            visit(ends_[i].site, ends_[i].relation);
        }
    }

    friend bool operator==(const GraphTopology&, const GraphTopology&) = default;

  private:
    struct FarEnd {
        Site site = 0;
        RelationId relation = 0;

        friend bool operator==(const FarEnd&, const FarEnd&) = default;
    };

    // Far ends of the arcs at site s: ends_[first_end_[s] ... first_end_[s + 1]-1].
    std::vector<std::uint32_t> first_end_;
    std::vector<FarEnd> ends_;
};

// Any sites of a whole, in rising order, with the arcs among them and those that lead out.
class GraphPart {
  public:
    using Inner = GraphTopology;
    static constexpr std::size_t kOutwardGroups = 1;

    struct OutwardArc {
        Site inside = 0;
        Site outside = 0;  // in the whole
        RelationId relation = 0;
    };

    // Shape: `sites` are numbers in the whole; the inner topology numbers them in their order.
    GraphPart(GraphTopology inner, std::vector<Site> sites, std::vector<OutwardArc> outward)
        : inner_(std::move(inner)), sites_(std::move(sites)), outward_(std::move(outward)) {}

    [[nodiscard]] const GraphTopology& inner() const { return inner_; }

    [[nodiscard]] std::span<const Site> sites() const { return sites_; }

    [[nodiscard]] Site global(Site site) const { return sites_[site]; }

    template <class Visit>
    void for_each_run(Visit visit) const {
        for (std::size_t first = 0, end = 0; first < sites_.size(); first = end) {
            do {
                ++end;
            } while (end < sites_.size() && sites_[end] == sites_[end - 1] + 1);
            visit(static_cast<Site>(first), sites_[first], end - first);
        }
    }

    template <class Visit>
    void for_each_outward_arc(Visit visit) const {
        for (const OutwardArc& arc : outward_) {
            visit(arc.inside, arc.outside, arc.relation);
        }
    }

    template <class Visit>
    void for_each_outward_arc(std::size_t /*group*/, Visit visit) const {
        for_each_outward_arc(visit);
    }

  private:
    GraphTopology inner_;
    std::vector<Site> sites_;
    std::vector<OutwardArc> outward_;
};

}  // namespace modelsynth
