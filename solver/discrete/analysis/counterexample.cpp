#include "solver/discrete/analysis/counterexample.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/core/random.h"
#include "solver/discrete/scan_order.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>

namespace modelsynth::discrete {

namespace {

// What RandomKey::purpose says of the streams drawn here: this, and the next ones in later
// passes.
constexpr std::uint32_t kPurposeCounterexample = 16;
constexpr std::uint32_t kPasses = 3;
constexpr std::uint32_t kMoreRuns = 4;  // in a pass than in the one before

// Steps for the proof that a shorter prefix has no completion either.
constexpr std::uint64_t kShortenSteps = 256;

// Steps to tell whether a cell can be left out.
constexpr std::uint64_t kCoreSteps = 64;

// Boxes by rising volume: all shapes while small, then only those as long as wide.
std::vector<GridSize> boxes(const Transitions& transitions) {
    const bool is_planar = transitions.open_count() < 3;
    const std::int32_t any_shape_max = is_planar ? 6 : 4;
    const auto sides = is_planar ? std::array<std::int32_t, 4>{7, 8, 12, 16}
                                 : std::array<std::int32_t, 4>{5, 6, 8, 10};
    const auto extent = [&](std::size_t axis, std::int32_t cells) {
        return transitions.open[axis] ? cells : 1;
    };
    std::vector<GridSize> all;
    for (std::int32_t x = 2; x <= any_shape_max; ++x) {
        for (std::int32_t y = 2; y <= any_shape_max; ++y) {
            for (std::int32_t z = 2; z <= any_shape_max; ++z) {
                all.push_back({extent(0, x), extent(1, y), extent(2, z)});
            }
        }
    }
    for (const std::int32_t side : sides) {
        all.push_back({extent(0, side), extent(1, side), extent(2, side)});
    }
    const auto key = [](const GridSize& box) {
        return std::tuple(box.cell_count(), box.x, box.y, box.z);
    };
    std::sort(all.begin(), all.end(), [&key](const GridSize& a, const GridSize& b) {
        return key(a) < key(b);
    });
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

// Runs in one box.
class BoxRuns {
  public:
    BoxRuns(const Transitions& transitions, const GridSize& box, Work& work)
        : transitions_(transitions),
          box_(box),
          work_(work),
          topology_(box),
          catalog_(topology_, transitions.relations),
          scan_(column_order(box)) {
        catalog_.fill(transitions.labels.words());
        catalog_.enqueue_all();
        is_possible_ = catalog_.propagate(work.stop()) == Propagation::kConsistent;
        start_.assign(catalog_.all_labels().begin(), catalog_.all_labels().end());
    }

    // Whether arc consistency alone leaves labels everywhere.
    [[nodiscard]] bool is_possible() const { return is_possible_; }

    // One run: the first counterexample without a choice, which ends it, or else the first with
    // one.
    std::optional<Counterexample> run(RandomStream random) {
        catalog_.restore(start_);
        std::optional<Counterexample> seen;
        std::vector<PlacedLabel> placed;
        while (placed.size() < scan_.size()) {
            const Site site = scan_[placed.size()];
            const PlacedLabel choice = {box_.cell(site), draw(site, random)};
            if (!has_several(catalog_.labels(site))) {
                placed.push_back(choice);
                continue;
            }
            switch (place(site, choice.label)) {
                case Propagation::kConsistent:
                    continue;
                case Propagation::kStopped:
                    return seen;
                case Propagation::kContradiction:
                    break;
            }
            if (!seen) {
                seen = {box_, placed, choice, {}};
            }
            if (!catalog_.remove(site, choice.label) ||
                catalog_.propagate(work_.stop()) == Propagation::kContradiction) {
                // Neither the label nor any other can follow what was placed.
                return Counterexample{box_, shorten(std::move(placed)), std::nullopt, {}};
            }
        }
        return seen;
    }

  private:
    Label draw(Site site, RandomStream& random) const {
        const auto set = catalog_.labels(site);
        auto left = random.below(static_cast<std::uint32_t>(count_labels(set)));
        Label drawn = kNoLabel;
        for_each_label(set, [&](Label label) {
            if (left-- == 0) {
                drawn = label;
            }
        });
        return drawn;
    }

    // With a contradiction, the catalog is as before; kStopped also when no work is left.
    Propagation place(Site site, Label label) {
        if (!work_.take()) {
            return Propagation::kStopped;
        }
        const auto mark = catalog_.mark();
        catalog_.assign(site, label);
        const Propagation propagation = catalog_.propagate(work_.stop());
        if (propagation == Propagation::kConsistent) {
            catalog_.keep();
        } else {
            catalog_.undo(mark);
        }
        return propagation;
    }

    // The fewest of the first labels that still are proved to have no completion.
    std::vector<PlacedLabel> shorten(std::vector<PlacedLabel> placed) {
        while (!placed.empty()) {
            const PlacedLabel last = placed.back();
            placed.pop_back();
            const Completion completion = work_.with_share(kShortenSteps, [&](Work& share) {
                return find_completion(transitions_, box_, placed, share);
            });
            if (completion != Completion::kNone) {
                placed.push_back(last);
                break;
            }
        }
        return placed;
    }

    const Transitions& transitions_;
    GridSize box_;
    Work& work_;
    GridTopology topology_;
    Catalog<GridTopology, 0> catalog_;
    std::vector<Site> scan_;
    std::vector<Word> start_;
    bool is_possible_ = false;
};

// Leaves out one cell after the other, the first ones first: they are the farthest from the choice.
std::vector<PlacedLabel> find_core(
    const Transitions& transitions, const Counterexample& counterexample, Work& work
) {
    std::vector<PlacedLabel> core = counterexample.cells;
    if (counterexample.choice) {
        core.push_back(*counterexample.choice);
    }
    for (std::size_t i = 0; i < core.size();) {
        const PlacedLabel left_out = core[i];
        const auto place = core.begin() + static_cast<std::ptrdiff_t>(i);
        core.erase(place);
        const Completion completion = work.with_share(kCoreSteps, [&](Work& share) {
            return find_completion(transitions, counterexample.box, core, share);
        });
        if (completion != Completion::kNone || left_out == counterexample.choice) {
            core.insert(core.begin() + static_cast<std::ptrdiff_t>(i), left_out);
            ++i;
        }
    }
    if (counterexample.choice) {
        core.pop_back();
    }
    return core;
}

// One pass over the boxes: the first counterexample without a choice, or else the first with one.
std::optional<Counterexample> search_boxes(
    const Transitions& transitions,
    std::uint32_t pass,
    const CounterexampleSearch& search,
    Work& work
) {
    std::optional<Counterexample> with_choice;
    std::uint32_t number = 0;
    for (const GridSize& box : boxes(transitions)) {
        if (box.cell_count() > search.box_cells_max || !work.take()) {
            break;
        }
        BoxRuns runs(transitions, box, work);
        ++number;
        for (std::uint32_t run = 0; runs.is_possible() && run < search.runs; ++run) {
            const RandomKey key = {search.seed, number, run, kPurposeCounterexample + pass};
            auto seen = runs.run(RandomStream(key));
            if (seen && !seen->choice) {
                return seen;
            }
            if (seen && !with_choice) {
                with_choice = std::move(seen);
            }
        }
    }
    return with_choice;
}

}  // namespace

std::optional<Counterexample> find_counterexample(
    const Transitions& transitions, const CounterexampleSearch& search, Work& work
) {
    if (transitions.labels.empty()) {
        return std::nullopt;
    }
    // What is kept back is enough to make the answer smaller.
    const std::uint64_t steps_kept = work.left() / 4;
    std::optional<Counterexample> found;
    CounterexampleSearch of_pass = search;
    for (std::uint32_t pass = 0; pass < kPasses && work.left() > steps_kept; ++pass) {
        auto seen = work.with_share(work.left() - steps_kept, [&](Work& share) {
            return search_boxes(transitions, pass, of_pass, share);
        });
        if (seen && (!found || !seen->choice)) {
            found = std::move(seen);
        }
        if (found && !found->choice) {
            break;
        }
        of_pass.runs *= kMoreRuns;
    }
    if (found) {
        found->core = find_core(transitions, *found, work);
    }
    return found;
}

}  // namespace modelsynth::discrete
