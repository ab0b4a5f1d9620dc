#include "solver/continuous/graph_part.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// Numbers of sites by their place in a list of them in rising order, which most follow each other
// in. Who asks along one heading after the other is mostly answered by the run of the last time.
class SiteNumbers {
  public:
    explicit SiteNumbers(std::span<const Site> sites) {
        for (std::size_t i = 0; i < sites.size(); ++i) {
            if (i == 0 || sites[i] != sites[i - 1] + 1) {
                runs_.push_back({sites[i], sites[i], static_cast<Site>(i)});
            }
            ++runs_.back().end;
        }
    }

    // kNoSite where it is none of them.
    [[nodiscard]] Site find(Site site, std::size_t heading) {
        if (heading >= last_.size()) {
            last_.resize(heading + 1);
        }
        std::size_t& last = last_[heading];
        if (!is_in(runs_[last], site)) {
            const auto after =
                std::upper_bound(runs_.begin(), runs_.end(), site, [](Site value, const Run& run) {
                    return value < run.first;
                });
            if (after == runs_.begin() || !is_in(*std::prev(after), site)) {
                return kNoSite;
            }
            last = static_cast<std::size_t>(std::prev(after) - runs_.begin());
        }
        return runs_[last].number + (site - runs_[last].first);
    }

  private:
    struct Run {
        Site first;
        Site end;
        Site number;  // of the first
    };

    static bool is_in(const Run& run, Site site) { return site >= run.first && site < run.end; }

    std::vector<Run> runs_;
    std::vector<std::size_t> last_;  // by heading, the run in which one was found
};

}  // namespace

GraphPart part_of(
    const Arrangement& arrangement, std::vector<Site> vertices, const Symmetries* symmetries
) {
    if (symmetries != nullptr) {
        vertices = symmetries->close(std::move(vertices));
    }
    SiteNumbers numbers(vertices);
    std::vector<GraphArc> arcs;
    std::vector<GraphPart::OutwardArc> outward;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        for (const ArrangementEdge& edge : arrangement.edges(vertices[i])) {
            if (edge.end == kNoSite) {
                continue;
            }
            const Site far = numbers.find(edge.end, edge.heading);
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
