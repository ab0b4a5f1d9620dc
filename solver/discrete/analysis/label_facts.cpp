#include "solver/discrete/analysis/label_facts.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"
#include "solver/discrete/initial_model.h"
#include "solver/discrete/problem.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace modelsynth::discrete {

namespace {

constexpr std::int32_t kPatchExtent = 21;

using GridCatalog = Catalog<GridTopology, 0>;

// What the boundary and the constraints leave, less what has no neighbour then.
Propagation fill(GridCatalog& catalog, const Problem& problem, const std::stop_token& stop) {
    std::vector<Word> sets;
    sets.reserve(catalog.all_labels().size());
    for (std::size_t site = 0; site < catalog.site_count(); ++site) {
        const auto own = problem.domains.words(static_cast<Site>(site));
        sets.insert(sets.end(), own.begin(), own.end());
    }
    catalog.restore(sets);
    catalog.enqueue_all();
    return catalog.propagate(stop);
}

void count_cells(const Example& example, LabelFacts& facts) {
    const std::size_t labels = example.pieces.size();
    facts.counts.assign(labels, 0);
    for (const Label label : example.cells) {
        ++facts.counts[label];
    }
    std::vector<bool> is_paired(labels);
    for (const AdjacentPair& pair : example.adjacency) {
        is_paired[pair.lower] = true;
        is_paired[pair.upper] = true;
    }
    facts.absent = LabelSet(labels);
    facts.once = LabelSet(labels);
    for (std::size_t label = 0; label < labels; ++label) {
        if (!is_paired[label] && facts.counts[label] == 0) {
            facts.absent.insert(static_cast<Label>(label));
        }
        if (!is_paired[label] && facts.counts[label] == 1) {
            facts.once.insert(static_cast<Label>(label));
        }
    }
}

void find_self_adjacent(const Transitions& transitions, LabelFacts& facts) {
    facts.repeating = transitions.labels;
    for (std::size_t axis = 0; axis < facts.self_adjacent.size(); ++axis) {
        LabelSet& own = facts.self_adjacent[axis];
        own = LabelSet(transitions.labels.label_count());
        for_each_label(transitions.labels.words(), [&](Label label) {
            if (transitions.relations.allows(static_cast<RelationId>(2 * axis), label, label)) {
                own.insert(label);
            }
        });
        if (transitions.open[axis]) {
            facts.repeating &= own;
        }
    }
}

// Places labels in the middle column of a model, one at a time.
class Placer {
  public:
    Placer(const Problem& problem, Work& work)
        : size_(problem.size),
          work_(work),
          label_count_(problem.relations.label_count()),
          topology_(problem.size, problem.periodic),
          catalog_(topology_, problem.relations) {
        is_possible_ = fill(catalog_, problem, work.stop()) == Propagation::kConsistent;
        for (std::size_t site = 0; site < catalog_.site_count(); ++site) {
            is_known_.push_back(!has_several(catalog_.labels(static_cast<Site>(site))));
        }
    }

    // Nothing when it stands nowhere in the column, where something else could, or leaves a
    // neighbour open somewhere; or no work is left to tell.
    std::optional<ForcedPatch> place(Label label) {
        std::optional<ForcedPatch> least;
        for (std::int32_t y = 0; is_possible_ && y < size_.y; ++y) {
            const auto site = static_cast<Site>(size_.index({size_.x / 2, y, size_.z / 2}));
            if (is_known_[site] || !catalog_.contains(site, label)) {
                continue;
            }
            if (!work_.take()) {
                return std::nullopt;
            }
            const auto mark = catalog_.mark();
            catalog_.assign(site, label);
            const bool can_stand = catalog_.propagate(work_.stop()) == Propagation::kConsistent;
            const bool is_forcing = can_stand && knows_neighbours(site);
            if (is_forcing) {
                ForcedPatch patch = find_patch(label);
                if (!least || patch.cell_count < least->cell_count) {
                    least = std::move(patch);
                }
            }
            catalog_.undo(mark);
            if (can_stand && !is_forcing) {
                return std::nullopt;
            }
        }
        return least;
    }

  private:
    [[nodiscard]] bool knows_neighbours(Site site) const {
        bool all = true;
        topology_.for_each_arc(site, [&](Site neighbour, RelationId) {
            all = all && !has_several(catalog_.labels(neighbour));
        });
        return all;
    }

    // The cells that are known now and were not before.
    [[nodiscard]] ForcedPatch find_patch(Label label) const {
        ForcedPatch patch = {label, 0, LabelSet(label_count_), true};
        for (std::size_t site = 0; site < is_known_.size(); ++site) {
            const auto set = catalog_.labels(static_cast<Site>(site));
            if (is_known_[site] || has_several(set)) {
                continue;
            }
            ++patch.cell_count;
            for_each_label(set, [&patch](Label known) { patch.labels.insert(known); });
            const Cell cell = size_.cell(site);
            patch.is_whole = patch.is_whole && cell.x > 0 && cell.z > 0 && cell.x + 1 < size_.x &&
                             cell.z + 1 < size_.z;
        }
        return patch;
    }

    GridSize size_;
    Work& work_;
    std::size_t label_count_;
    GridTopology topology_;
    GridCatalog catalog_;
    bool is_possible_ = false;
    std::vector<bool> is_known_;
};

void find_unreachable(
    const Example& example,
    const Problem& problem,
    const LabelSet& labels,
    const std::stop_token& stop,
    LabelFacts& facts
) {
    const GridTopology topology(problem.size, problem.periodic);
    GridCatalog catalog(topology, problem.relations);
    if (fill(catalog, problem, stop) != Propagation::kConsistent) {
        BlockResult impossible;
        impossible.impossible_site = catalog.emptied_site();
        facts.contradiction = contradiction_of(example, problem, impossible).message;
        return;
    }
    facts.unreachable = labels;
    for (std::size_t site = 0; site < catalog.site_count() && !facts.unreachable.empty(); ++site) {
        for_each_label(catalog.labels(static_cast<Site>(site)), [&facts](Label label) {
            facts.unreachable.erase(label);
        });
    }
}

void find_forced(const Example& example, Parameters parameters, Work& work, LabelFacts& facts) {
    parameters.size->x = std::min(parameters.size->x, kPatchExtent);
    parameters.size->z = std::min(parameters.size->z, kPatchExtent);
    parameters.constraints.clear();
    const auto problem = make_problem(example, parameters);
    if (!problem) {
        return;
    }
    Placer placer(*problem, work);
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        if (auto patch = placer.place(static_cast<Label>(label)); patch && patch->cell_count > 1) {
            facts.forced.push_back(std::move(*patch));
        }
    }
    facts.are_forced_complete = work.left() > 0;
}

}  // namespace

Result<LabelFacts> find_label_facts(
    const Example& example,
    const Parameters& parameters,
    const std::stop_token& stop,
    std::uint64_t placements_max
) {
    LabelFacts facts;
    count_cells(example, facts);
    const Transitions transitions = read_transitions(example);
    find_self_adjacent(transitions, facts);
    facts.unreachable = LabelSet(example.pieces.size());
    if (const auto problem = make_problem(example, parameters)) {
        facts.has_plain_model = find_plain_model(example, *problem).has_value();
        find_unreachable(example, *problem, transitions.labels, stop, facts);
    } else {
        facts.contradiction = problem.error().message;
    }
    if (!facts.contradiction) {
        Work work(placements_max, stop);
        find_forced(example, parameters, work, facts);
    }
    if (stop.stop_requested()) {
        return tl::unexpected(Error{ErrorCode::kCancelled, "the analysis was stopped", {}});
    }
    return facts;
}

}  // namespace modelsynth::discrete
