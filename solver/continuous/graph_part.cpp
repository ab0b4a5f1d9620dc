#include "solver/continuous/graph_part.h"

#include <algorithm>
#include <utility>

namespace modelsynth::continuous {

GraphPart part_of(
    const Arrangement& arrangement, std::vector<Site> vertices, const Symmetries* symmetries
) {
    if (symmetries != nullptr) {
        vertices = symmetries->close(std::move(vertices));
    }
    const auto inside = [&](Site site) {
        const auto at = std::lower_bound(vertices.begin(), vertices.end(), site);
        return at != vertices.end() && *at == site ? static_cast<Site>(at - vertices.begin())
                                                   : kNoSite;
    };
    std::vector<GraphArc> arcs;
    std::vector<GraphPart::OutwardArc> outward;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        for (const ArrangementEdge& edge : arrangement.edges(vertices[i])) {
            if (edge.end == kNoSite) {
                continue;
            }
            const Site far = inside(edge.end);
            if (far == kNoSite) {
                outward.push_back({static_cast<Site>(i), edge.end, edge.heading});
            } else if (edge.heading % 2 == 0) {
                arcs.push_back({static_cast<Site>(i), far, edge.heading, opposite(edge.heading)});
            }
        }
    }
    if (symmetries != nullptr) {
        const std::vector<GraphArc> to_images = symmetries->arcs(vertices);
        arcs.insert(arcs.end(), to_images.begin(), to_images.end());
    }
    GraphTopology inner(vertices.size(), arcs);
    return {std::move(inner), std::move(vertices), std::move(outward)};
}

}  // namespace modelsynth::continuous
