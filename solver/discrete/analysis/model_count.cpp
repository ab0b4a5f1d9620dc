#include "solver/discrete/analysis/model_count.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/discrete/analysis/work.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

constexpr std::uint64_t kCountMax = std::numeric_limits<std::uint64_t>::max();

std::uint64_t add(std::uint64_t a, std::uint64_t b) {
    return b > kCountMax - a ? kCountMax : a + b;
}

// Adds a cell at a time, the longest axis slowest: the cells that later ones touch are then as few
// as can be.
class Transfer {
  public:
    Transfer(
        const Transitions& transitions,
        const GridSize& size,
        const ModelCountLimit& limit,
        Work& work
    )
        : transitions_(transitions), profiles_max_(limit.profiles_max), work_(work) {
        const std::array<std::int32_t, 3> cells = {size.x, size.y, size.z};
        std::array<std::size_t, 3> axes = {0, 1, 2};
        std::stable_sort(axes.begin(), axes.end(), [&cells](std::size_t a, std::size_t b) {
            return cells[a] < cells[b];
        });
        std::size_t stride = 1;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const auto extent = static_cast<std::size_t>(cells[axes[i]]);
            steps_[i] = {static_cast<RelationId>(2 * axes[i]), stride, extent};
            stride *= extent;
        }
        profile_cells_ = steps_[2].stride;
        cell_count_ = stride;
    }

    // Nothing when it passes a limit.
    std::optional<std::uint64_t> count() {
        Profiles profiles = {{std::vector<Label>(profile_cells_, kNoLabel), 1}};
        for (std::size_t cell = 0; cell < cell_count_; ++cell) {
            Profiles next;
            for (const auto& [profile, count] : profiles) {
                if (!add_cell(cell, profile, count, next)) {
                    return std::nullopt;
                }
            }
            profiles = std::move(next);
        }
        return std::accumulate(
            profiles.begin(),
            profiles.end(),
            std::uint64_t{0},
            [](std::uint64_t sum, const auto& profile) { return add(sum, profile.second); }
        );
    }

  private:
    // The label of the newest cell of every line along the slowest axis.
    using Profiles = std::map<std::vector<Label>, std::uint64_t>;

    struct Step {
        RelationId relation = 0;
        std::size_t stride = 1;  // from a cell to the next
        std::size_t extent = 1;
    };

    bool add_cell(
        std::size_t cell, const std::vector<Label>& profile, std::uint64_t count, Profiles& next
    ) {
        std::vector<Word> allowed(
            transitions_.labels.words().begin(), transitions_.labels.words().end()
        );
        for (const Step& step : steps_) {
            if (cell / step.stride % step.extent == 0) {
                continue;
            }
            // A line's newest cell is the one before this cell for the slowest axis, and that of
            // another line for the others.
            const Label before = profile[(cell - step.stride) % profile_cells_];
            const auto row = transitions_.relations.row(step.relation, before);
            for (std::size_t word = 0; word < allowed.size(); ++word) {
                allowed[word] &= row[word];
            }
        }
        bool within_limits = true;
        std::vector<Label> grown = profile;
        for_each_label(allowed, [&](Label label) {
            within_limits = within_limits && work_.take();
            if (!within_limits) {
                return;
            }
            grown[cell % profile_cells_] = label;
            std::uint64_t& sum = next[grown];
            sum = add(sum, count);
            within_limits = next.size() <= profiles_max_;
        });
        return within_limits;
    }

    const Transitions& transitions_;
    std::size_t profiles_max_;
    Work& work_;
    std::array<Step, 3> steps_;
    std::size_t profile_cells_ = 1;
    std::size_t cell_count_ = 1;
};

// Finds models one after the other.
class Enumeration {
  public:
    Enumeration(const Transitions& transitions, const GridSize& size, Work& work)
        : work_(work), topology_(size), catalog_(topology_, transitions.relations) {
        catalog_.fill(transitions.labels.words());
        catalog_.enqueue_all();
    }

    ModelCount count() {
        const bool is_complete = visit(0, catalog_.propagate(work_.stop()));
        return {found_, is_complete};
    }

  private:
    // False when the work was used up.
    bool visit(std::size_t site, Propagation propagation) {
        if (propagation != Propagation::kConsistent) {
            return propagation == Propagation::kContradiction;
        }
        while (site < catalog_.site_count() &&
               !has_several(catalog_.labels(static_cast<Site>(site)))) {
            ++site;
        }
        if (site == catalog_.site_count()) {
            found_ = add(found_, 1);
            return true;
        }
        const auto set = catalog_.labels(static_cast<Site>(site));
        const std::vector<Word> open(set.begin(), set.end());
        bool is_complete = true;
        for_each_label(open, [&](Label label) {
            is_complete = is_complete && work_.take();
            if (!is_complete) {
                return;
            }
            const auto mark = catalog_.mark();
            catalog_.assign(static_cast<Site>(site), label);
            is_complete = visit(site + 1, catalog_.propagate(work_.stop()));
            catalog_.undo(mark);
        });
        return is_complete;
    }

    Work& work_;
    GridTopology topology_;
    Catalog<GridTopology, 0> catalog_;
    std::uint64_t found_ = 0;
};

ModelCount count_within(
    const Transitions& transitions, const GridSize& size, const ModelCountLimit& limit, Work& work
) {
    if (transitions.labels.empty()) {
        return {0, true};
    }
    const auto counted = work.with_share(limit.steps_max / 2, [&](Work& share) {
        return Transfer(transitions, size, limit, share).count();
    });
    if (counted) {
        return {*counted, *counted < kCountMax};
    }
    return Enumeration(transitions, size, work).count();
}

}  // namespace

Result<ModelCount> count_models(
    const Transitions& transitions,
    const GridSize& size,
    const ModelCountLimit& limit,
    const std::stop_token& stop
) {
    check(size.x > 0 && size.y > 0 && size.z > 0, "models without cells were to be counted");
    if (size.cell_count() > kCountedCellsMax) {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "models of " + std::to_string(size.cell_count()) + " cells are too large to be counted",
            {}});
    }
    Work work(limit.steps_max, stop);
    const ModelCount count = count_within(transitions, size, limit, work);
    if (stop.stop_requested()) {
        return tl::unexpected(Error{ErrorCode::kCancelled, "the analysis was stopped", {}});
    }
    return count;
}

}  // namespace modelsynth::discrete
