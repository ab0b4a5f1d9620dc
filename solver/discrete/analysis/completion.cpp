#include "solver/discrete/analysis/completion.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/core/result.h"

#include <vector>

namespace modelsynth::discrete {

namespace {

class Completer {
  public:
    Completer(const Transitions& transitions, const GridSize& box, Work& work)
        : labels_(transitions.labels),
          box_(box),
          work_(work),
          topology_(box),
          catalog_(topology_, transitions.relations) {}

    Completion complete(std::span<const PlacedLabel> placed) {
        if (!work_.take()) {
            return Completion::kUnknown;
        }
        if (labels_.empty()) {
            return Completion::kNone;
        }
        catalog_.fill(labels_.words());
        catalog_.enqueue_all();
        for (const PlacedLabel& each : placed) {
            check(box_.contains(each.cell), "a label placed outside the box");
            const auto site = static_cast<Site>(box_.index(each.cell));
            if (!catalog_.contains(site, each.label)) {
                return Completion::kNone;
            }
            catalog_.assign(site, each.label);
        }
        return search(catalog_.propagate(work_.stop()));
    }

  private:
    Completion search(Propagation propagation) {
        if (propagation != Propagation::kConsistent) {
            return propagation == Propagation::kContradiction ? Completion::kNone
                                                              : Completion::kUnknown;
        }
        Site site = 0;
        if (!find_open_site(site)) {
            return Completion::kExists;
        }
        const auto set = catalog_.labels(site);
        const std::vector<Word> open(set.begin(), set.end());
        Completion found = Completion::kNone;
        for_each_label(open, [&](Label label) {
            if (found != Completion::kNone) {
                return;
            }
            if (!work_.take()) {
                found = Completion::kUnknown;
                return;
            }
            const auto mark = catalog_.mark();
            catalog_.assign(site, label);
            found = search(catalog_.propagate(work_.stop()));
            catalog_.undo(mark);
        });
        return found;
    }

    // The first site with the fewest labels of those with several; false when there is none.
    bool find_open_site(Site& site) const {
        std::size_t fewest = kLabelCountMax + 1;
        for (std::size_t each = 0; each < catalog_.site_count(); ++each) {
            const std::size_t count = count_labels(catalog_.labels(static_cast<Site>(each)));
            if (count > 1 && count < fewest) {
                fewest = count;
                site = static_cast<Site>(each);
            }
        }
        return fewest <= kLabelCountMax;
    }

    const LabelSet& labels_;
    GridSize box_;
    Work& work_;
    GridTopology topology_;
    Catalog<GridTopology, 0> catalog_;
};

}  // namespace

Completion find_completion(
    const Transitions& transitions,
    const GridSize& box,
    std::span<const PlacedLabel> placed,
    Work& work
) {
    return Completer(transitions, box, work).complete(placed);
}

}  // namespace modelsynth::discrete
