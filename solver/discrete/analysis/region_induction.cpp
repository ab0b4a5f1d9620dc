// Every state of a window is a prefix of its cells in scan order, since the order of the whole
// restricted to a window is the window's own. States are walked as a tree, one label deeper each
// time, and left out with all that follows as soon as they are dead. For a pair of windows, what
// R offers at p is kept for each labelling of their overlap; then the other window's states
// are walked once.

#include "solver/discrete/analysis/region_induction.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/core/result.h"
#include "solver/discrete/scan_order.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace modelsynth::discrete {

namespace {

// A window's extent along an axis: exactly that of the model, or less than or equal to it.
struct Extent {
    std::int32_t cells = 1;
    bool is_models = true;
};

// Along one axis: where p is in R, and where the other window begins, seen from R.
struct AxisCase {
    std::int32_t place = 0;
    std::int32_t shift = 0;
};

std::vector<AxisCase> axis_cases(const Extent& extent) {
    std::vector<AxisCase> cases;
    if (extent.is_models) {
        for (std::int32_t place = 0; place < extent.cells; ++place) {
            cases.push_back({place, 0});
        }
        return cases;
    }
    // At the first cell of the model only the first window has it.
    cases.push_back({0, 0});
    for (std::int32_t shift = 2 - extent.cells; shift <= 1; ++shift) {
        cases.push_back({1, shift});
    }
    // R stands at the far side; windows begin no farther on, and reach p.
    for (std::int32_t place = 2; place < extent.cells; ++place) {
        for (std::int32_t shift = place - extent.cells + 1; shift <= 0; ++shift) {
            cases.push_back({place, shift});
        }
    }
    return cases;
}

// Extents of the windows of models of all sizes.
std::vector<Extent> extents_along(bool open, std::int32_t region) {
    if (!open) {
        return {{1, true}};
    }
    std::vector<Extent> extents;
    for (std::int32_t cells = 2; cells < region; ++cells) {
        extents.push_back({cells, true});
    }
    extents.push_back({region, false});
    return extents;
}

// The induction for models whose windows have one size.
class WindowInduction {
  public:
    WindowInduction(
        const Transitions& transitions, const std::array<Extent, 3>& extents, Work& work
    )
        : work_(work),
          extents_(extents),
          size_({extents[0].cells, extents[1].cells, extents[2].cells}),
          topology_(size_),
          catalog_(topology_, transitions.relations),
          scan_(column_order(size_)),
          rank_(scan_.size()) {
        for (std::size_t rank = 0; rank < scan_.size(); ++rank) {
            rank_[scan_[rank]] = rank;
        }
        catalog_.fill(transitions.labels.words());
        catalog_.enqueue_all();
    }

    ProofOutcome prove() {
        if (!work_.take()) {
            return ProofOutcome::kNoWork;
        }
        const Propagation start = catalog_.propagate(work_.stop());
        if (start != Propagation::kConsistent) {
            return start == Propagation::kStopped ? ProofOutcome::kNoWork : ProofOutcome::kProved;
        }
        for (const AxisCase& x : axis_cases(extents_[0])) {
            for (const AxisCase& z : axis_cases(extents_[2])) {
                for (const AxisCase& y : axis_cases(extents_[1])) {
                    const ProofOutcome outcome =
                        check_pair({x.place, y.place, z.place}, {x.shift, y.shift, z.shift});
                    if (outcome != ProofOutcome::kProved) {
                        return outcome;
                    }
                }
            }
        }
        return ProofOutcome::kProved;
    }

  private:
    using Offered = std::map<std::vector<Label>, std::vector<Word>>;  // by the overlap's labels

    // R with p at `place`, and the window that begins `shift` from it.
    ProofOutcome check_pair(const Cell& place, const Cell& shift) {
        const Cell other_place = {place.x - shift.x, place.y - shift.y, place.z - shift.z};
        const std::size_t length = rank_[size_.index(place)];
        const std::size_t other_length = rank_[size_.index(other_place)];
        std::vector<Site> overlap;        // sites of R
        std::vector<Site> other_overlap;  // the same cells as sites of the other window
        for (std::size_t rank = 0; rank < length; ++rank) {
            const Cell cell = size_.cell(scan_[rank]);
            const Cell seen = {cell.x - shift.x, cell.y - shift.y, cell.z - shift.z};
            if (size_.contains(seen)) {
                overlap.push_back(scan_[rank]);
                other_overlap.push_back(static_cast<Site>(size_.index(seen)));
            }
        }
        Offered offered;
        const ProofOutcome walked = walk(0, length, [&] {
            std::vector<Word>& set = offered[labels_at(overlap)];
            const std::vector<Word> here = set_at(scan_[length]);
            set.resize(here.size());
            for (std::size_t word = 0; word < here.size(); ++word) {
                set[word] |= here[word];
            }
            return ProofOutcome::kProved;
        });
        if (walked != ProofOutcome::kProved) {
            return walked;
        }
        return walk(0, other_length, [&] {
            const auto found = offered.find(labels_at(other_overlap));
            return found == offered.end() ? ProofOutcome::kProved
                                          : check_labels(scan_[other_length], found->second);
        });
    }

    // Whether the window of the catalog is alive with each of the labels at the site.
    ProofOutcome check_labels(Site site, const std::vector<Word>& labels) {
        ProofOutcome outcome = ProofOutcome::kProved;
        for_each_label(labels, [&](Label label) {
            if (outcome != ProofOutcome::kProved) {
                return;
            }
            outcome = catalog_.contains(site, label) ? with_label(
                                                           site,
                                                           label,
                                                           [] { return ProofOutcome::kProved; },
                                                           ProofOutcome::kNotProved
                                                       )
                                                     : ProofOutcome::kNotProved;
        });
        return outcome;
    }

    // Calls visit() for every living state in which the first `length` cells have labels, as long
    // as it proves what it is to prove. The catalog is as before afterwards.
    template <class Visit>
    ProofOutcome walk(std::size_t depth, std::size_t length, const Visit& visit) {
        if (depth == length) {
            return visit();
        }
        const Site site = scan_[depth];
        ProofOutcome outcome = ProofOutcome::kProved;
        for_each_label(set_at(site), [&](Label label) {
            if (outcome == ProofOutcome::kProved) {
                outcome = with_label(
                    site,
                    label,
                    [&] { return walk(depth + 1, length, visit); },
                    ProofOutcome::kProved
                );
            }
        });
        return outcome;
    }

    // What `alive()` returns with the label at the site; `if_dead` when that leaves nothing.
    template <class Alive>
    ProofOutcome with_label(Site site, Label label, const Alive& alive, ProofOutcome if_dead) {
        if (!work_.take()) {
            return ProofOutcome::kNoWork;
        }
        const auto mark = catalog_.mark();
        catalog_.assign(site, label);
        const Propagation propagation = catalog_.propagate(work_.stop());
        const ProofOutcome outcome = propagation == Propagation::kConsistent ? alive()
                                     : propagation == Propagation::kContradiction
                                         ? if_dead
                                         : ProofOutcome::kNoWork;
        catalog_.undo(mark);
        return outcome;
    }

    [[nodiscard]] std::vector<Word> set_at(Site site) const {
        const auto set = catalog_.labels(site);
        return {set.begin(), set.end()};
    }

    // Requires: one label is left at each.
    [[nodiscard]] std::vector<Label> labels_at(const std::vector<Site>& sites) const {
        std::vector<Label> labels;
        for (const Site site : sites) {
            for_each_label(catalog_.labels(site), [&](Label label) { labels.push_back(label); });
        }
        return labels;
    }

    Work& work_;
    std::array<Extent, 3> extents_;
    GridSize size_;
    GridTopology topology_;
    Catalog<GridTopology, 0> catalog_;
    std::vector<Site> scan_;
    std::vector<std::size_t> rank_;  // of a site in the scan
};

}  // namespace

ProofOutcome prove_by_region(const Transitions& transitions, const GridSize& region, Work& work) {
    const std::array<std::int32_t, 3> cells = {region.x, region.y, region.z};
    std::array<std::vector<Extent>, 3> extents;
    for (std::size_t axis = 0; axis < extents.size(); ++axis) {
        check(
            transitions.open[axis] ? cells[axis] >= 2 : cells[axis] == 1,
            "a region that does not suit the open axes"
        );
        extents[axis] = extents_along(transitions.open[axis], cells[axis]);
    }
    for (const Extent& x : extents[0]) {
        for (const Extent& y : extents[1]) {
            for (const Extent& z : extents[2]) {
                const auto outcome = WindowInduction(transitions, {x, y, z}, work).prove();
                if (outcome != ProofOutcome::kProved) {
                    return outcome;
                }
            }
        }
    }
    return ProofOutcome::kProved;
}

GridSize smallest_region(const std::array<bool, 3>& open) {
    return {open[0] ? 2 : 1, open[1] ? 2 : 1, open[2] ? 2 : 1};
}

}  // namespace modelsynth::discrete
