#include "solver/core/graph_topology.h"

#include "solver/core/result.h"

#include <numeric>

namespace modelsynth {

GraphTopology::GraphTopology(std::size_t site_count, std::span<const GraphArc> arcs)
    : first_end_(site_count + 1), ends_(2 * arcs.size()) {
    for (const GraphArc& arc : arcs) {
        check(arc.a < site_count && arc.b < site_count, "an arc to a site that is not there");
        ++first_end_[arc.a];
        ++first_end_[arc.b];
    }
    // Each number is where the site's ends stop until they are put in, from the last to the first.
    std::partial_sum(first_end_.begin(), first_end_.end(), first_end_.begin());
    for (std::size_t i = arcs.size(); i-- > 0;) {
        const GraphArc& arc = arcs[i];
        ends_[--first_end_[arc.b]] = {arc.a, arc.from_b};
        ends_[--first_end_[arc.a]] = {arc.b, arc.from_a};
    }
}

}  // namespace modelsynth
