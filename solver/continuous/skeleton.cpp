#include "solver/continuous/skeleton.h"

namespace modelsynth::continuous {

Skeleton::Skeleton(const Arrangement& arrangement) {
    const std::size_t count = arrangement.vertex_count();
    first_end_.assign(count + 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const auto vertex = static_cast<Site>(i);
        for (const ArrangementEdge& edge : arrangement.edges(vertex)) {
            if (edge.end == kNoSite) {
                continue;
            }
            ++first_end_[i + 1];
            if (edge.heading % 2 == 0) {
                edges_.push_back({vertex, edge.end, edge.heading});
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        first_end_[i + 1] += first_end_[i];
    }
    ends_.resize(first_end_[count]);
    std::vector<std::uint32_t> next(first_end_.begin(), first_end_.end() - 1);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const auto site = static_cast<Site>(count + e);
        ends_[next[edges_[e].from]++] = site;
        ends_[next[edges_[e].to]++] = site;
    }
}

}  // namespace modelsynth::continuous
