#include "solver/discrete/analysis/infallibility.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/discrete/analysis/corner_condition.h"
#include "solver/discrete/analysis/region_induction.h"
#include "solver/discrete/analysis/work.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

constexpr std::int32_t kRegionExtentMax = 4;
constexpr std::size_t kRegionCellsMax = 12;

std::string text_of(const GridSize& size) {
    return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
}

std::string text_of(const Cell& cell) {
    return "[" + std::to_string(cell.x) + ", " + std::to_string(cell.y) + ", " +
           std::to_string(cell.z) + "]";
}

// Small ones first. The smallest is tried although Eq. 3.11 is much the same: it offers a
// label only if others can stand around it.
std::vector<GridSize> regions(const Transitions& transitions) {
    const auto extent_max = [&](std::size_t axis) {
        return transitions.open[axis] ? kRegionExtentMax : 1;
    };
    const auto extent_min = [&](std::size_t axis) { return transitions.open[axis] ? 2 : 1; };
    std::vector<GridSize> all;
    for (std::int32_t x = extent_min(0); x <= extent_max(0); ++x) {
        for (std::int32_t y = extent_min(1); y <= extent_max(1); ++y) {
            for (std::int32_t z = extent_min(2); z <= extent_max(2); ++z) {
                const GridSize region = {x, y, z};
                if (region.cell_count() <= kRegionCellsMax) {
                    all.push_back(region);
                }
            }
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const GridSize& a, const GridSize& b) {
        return a.cell_count() < b.cell_count();
    });
    return all;
}

// The smallest cube that arc consistency alone leaves nothing for. What is larger holds it.
std::optional<GridSize> find_impossible(const Transitions& transitions, Work& work) {
    constexpr std::array<std::int32_t, 8> kSides = {2, 3, 4, 5, 6, 8, 12, 16};
    for (const std::int32_t side : kSides) {
        if (transitions.labels.empty() || !work.take()) {
            break;
        }
        const auto extent = [&](std::size_t axis) { return transitions.open[axis] ? side : 1; };
        const GridSize size = {extent(0), extent(1), extent(2)};
        const GridTopology topology(size);
        Catalog<GridTopology, 0> catalog(topology, transitions.relations);
        catalog.fill(transitions.labels.words());
        catalog.enqueue_all();
        if (catalog.propagate(work.stop()) == Propagation::kContradiction) {
            return size;
        }
    }
    return std::nullopt;
}

void set_infallible(
    InfallibilityVerdict& verdict, InfallibilityProof proof, const std::string& because
) {
    verdict.kind = Infallibility::kInfallible;
    verdict.proof = proof;
    verdict.description =
        "A model made whole, cell after cell, never comes to a dead end: " + because + ".";
}

void set_fallible(InfallibilityVerdict& verdict, Counterexample counterexample) {
    verdict.kind = Infallibility::kFallible;
    const std::string where = "in a model of " + text_of(counterexample.box) + " cells, " +
                              std::to_string(counterexample.cells.size()) + " of them labelled, ";
    verdict.description =
        counterexample.choice
            ? "A model made whole can come to a dead end: " + where +
                  "the next cell is offered a label that nothing completes. It is noticed at once, "
                  "so trying another label may be enough."
            : "A model made whole can come to a dead end that is not noticed: " + where +
                  "every cell still has labels to choose from, yet nothing completes it.";
    verdict.counterexample = std::move(counterexample);
}

void judge(
    const Transitions& transitions,
    const CounterexampleSearch& search,
    Work& work,
    InfallibilityVerdict& verdict
) {
    if (transitions.open_count() <= 1) {
        set_infallible(
            verdict,
            InfallibilityProof::kOneAxis,
            "pieces are neighbours along one axis at most, where what the catalog offers is exact"
        );
        return;
    }
    const std::uint64_t steps_max = work.left();
    const ProofOutcome corners = work.with_share(steps_max / 4, [&](Work& share) {
        return check_corners(transitions, share);
    });
    if (corners == ProofOutcome::kProved) {
        set_infallible(
            verdict, InfallibilityProof::kEquation311, "every corner can be closed (Eq. 3.11)"
        );
        return;
    }
    auto counterexample = work.with_share(steps_max / 2, [&](Work& share) {
        return find_counterexample(transitions, search, share);
    });
    if (counterexample) {
        set_fallible(verdict, std::move(*counterexample));
        return;
    }
    for (const GridSize& region : regions(transitions)) {
        const ProofOutcome outcome = work.with_share(steps_max / 4, [&](Work& share) {
            return prove_by_region(transitions, region, share);
        });
        if (outcome == ProofOutcome::kProved) {
            verdict.region = region;
            set_infallible(
                verdict,
                InfallibilityProof::kRegion,
                "a region of " + text_of(region) +
                    " cells around each cell is enough to see all "
                    "that can go wrong"
            );
            return;
        }
    }
    verdict.description =
        work.left() == 0
            ? "It was not found within the work allowed whether a model made whole can come to a "
              "dead end."
            : "No dead end was seen and none of the proofs holds, so a model made whole may or "
              "may not come to a dead end.";
}

}  // namespace

Result<InfallibilityVerdict> judge_infallibility(
    const Transitions& transitions, const InfallibilityOptions& options, const std::stop_token& stop
) {
    Work work(options.steps_max, stop);
    InfallibilityVerdict verdict;
    verdict.impossible_from = find_impossible(transitions, work);
    judge(transitions, options.search, work, verdict);
    if (verdict.impossible_from) {
        verdict.description +=
            " No model of " + text_of(*verdict.impossible_from) + " cells or more exists.";
    }
    if (stop.stop_requested()) {
        return tl::unexpected(Error{ErrorCode::kCancelled, "the analysis was stopped", {}});
    }
    verdict.steps = work.used();
    return verdict;
}

bool is_proved_infallible(const Example& example, std::uint64_t steps_max) {
    const bool is_free =
        std::all_of(example.boundary.begin(), example.boundary.end(), [](const SideBoundary& side) {
            return side.kind == BoundaryKind::kFree;
        });
    if (!is_free) {
        return false;
    }
    const Transitions transitions = read_transitions(example);
    if (transitions.open_count() <= 1) {
        return true;
    }
    Work work(steps_max, {});
    if (check_corners(transitions, work) == ProofOutcome::kProved) {
        return true;
    }
    const std::vector<GridSize> candidates = regions(transitions);
    return std::any_of(candidates.begin(), candidates.end(), [&](const GridSize& region) {
        return work.left() > 0 &&
               prove_by_region(transitions, region, work) == ProofOutcome::kProved;
    });
}

std::string describe(const Counterexample& counterexample, const Example& example) {
    const auto text = [&example](const PlacedLabel& placed) {
        return "\"" + example.pieces[placed.label].name + "\" at " + text_of(placed.cell);
    };
    std::string sentence = "In a model of " + text_of(counterexample.box) + " cells";
    for (std::size_t i = 0; i < counterexample.core.size(); ++i) {
        sentence += (i == 0 ? " with " : ", ") + text(counterexample.core[i]);
    }
    if (counterexample.choice) {
        return sentence + ", " + text(*counterexample.choice) +
               " seems possible, but nothing completes it.";
    }
    return sentence + ", every cell has pieces that seem possible, but nothing completes them.";
}

}  // namespace modelsynth::discrete
