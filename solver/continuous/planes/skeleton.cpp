#include "solver/continuous/planes/skeleton.h"

namespace modelsynth::continuous {

Skeleton::Skeleton(const Arrangement& arrangement) {
    const auto beyond = static_cast<Site>(arrangement.vertex_count());
    for (Site vertex = 0; vertex < beyond; ++vertex) {
        for (const ArrangementEdge& edge : arrangement.edges(vertex)) {
            if (edge.end == kNoSite) {
                edges_.push_back({vertex, beyond, edge.heading});
            } else if (edge.heading % 2 == 0) {  // else it is seen from its other end
                edges_.push_back({vertex, edge.end, edge.heading});
            }
        }
    }
    first_end_.assign(beyond + std::size_t{2}, 0);
    for (const Edge& edge : edges_) {
        ++first_end_[edge.from + 1];
        ++first_end_[edge.to + 1];
    }
    for (std::size_t site = 0; site <= beyond; ++site) {
        first_end_[site + 1] += first_end_[site];
    }
    ends_.resize(first_end_.back());
    std::vector<std::uint32_t> next(first_end_.begin(), first_end_.end() - 1);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const auto site = static_cast<Site>(beyond + 1 + e);
        ends_[next[edges_[e].from]++] = site;
        ends_[next[edges_[e].to]++] = site;
    }
}

}  // namespace modelsynth::continuous
