#include "solver/discrete/analysis/split_by_cells.h"

#include "solver/core/grid.h"
#include "solver/discrete/analysis/split_by_rules.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

class CellSplitter {
  public:
    CellSplitter(const Example& example, const Transitions& transitions, std::size_t capacity)
        : example_(example), transitions_(transitions), capacity_(capacity), cells_(example.cells) {
        for (std::size_t label = 0; label < example.pieces.size(); ++label) {
            originals_.push_back(static_cast<Label>(label));
        }
    }

    std::optional<SplitLabels> run(SplitOrder order, Work& work) {
        while (originals_.size() < capacity_ && take_for_reading(work)) {
            SplitLabels labels = read();
            SplitLabels going_on = labels;
            going_on.remove_ends();
            if (going_on.present().empty()) {
                break;
            }
            // Every label is split once before the example is read again.
            const std::vector<Label> before = cells_;
            LabelSet are_split(capacity_);
            ProofOutcome outcome =
                going_on.visit_conflicts(order, work, [&](const SplitConflict& conflict) {
                    if (!are_split.contains(conflict.label) &&
                        split(before, conflict.label, conflict.towards, conflict.neighbours)) {
                        are_split.insert(conflict.label);
                    }
                    return originals_.size() == capacity_;
                });
            if (outcome == ProofOutcome::kProved) {
                outcome = split_cube(going_on, work);
            }
            if (outcome == ProofOutcome::kProved) {
                return labels;
            }
            if (outcome == ProofOutcome::kNoWork) {
                break;
            }
            if (!has_split_) {
                // What would close the corners is an end itself; then pairs are to be forbidden.
                outcome = split_by_rules(going_on, order, work);
                return outcome == ProofOutcome::kProved ? std::optional(std::move(going_on))
                                                        : std::nullopt;
            }
            has_split_ = false;
        }
        return std::nullopt;
    }

  private:
    // Reading the example costs a step for some cells.
    bool take_for_reading(Work& work) const {
        constexpr std::size_t kCellsOfStep = 16;
        bool has_all = true;
        for (std::size_t cell = 0; cell < cells_.size() && has_all; cell += kCellsOfStep) {
            has_all = work.take();
        }
        return has_all;
    }

    // Calls visit(index, next index) for every cell and the one after it along the axis.
    template <class Visit>
    void visit_neighbours(std::size_t axis, const Visit& visit) const {
        const GridSize size = example_.size;
        const Cell step = kDirectionSteps[2 * axis];
        for (std::size_t index = 0; index < cells_.size(); ++index) {
            const Cell cell = size.cell(index);
            const Cell next = {cell.x + step.x, cell.y + step.y, cell.z + step.z};
            if (size.contains(next)) {
                visit(index, size.index(next));
            }
        }
    }

    [[nodiscard]] SplitLabels read() const {
        SplitLabels labels(transitions_.open, capacity_);
        for (const Label original : originals_) {
            labels.add(original);
        }
        const auto is_usable = [this](Label label) {
            return transitions_.labels.contains(originals_[label]);
        };
        for (std::size_t axis = 0; axis < transitions_.open.size(); ++axis) {
            visit_neighbours(axis, [&](std::size_t index, std::size_t next) {
                if (is_usable(cells_[index]) && is_usable(cells_[next])) {
                    labels.allow(axis, cells_[index], cells_[next]);
                }
            });
        }
        for (const AdjacentPair& pair : example_.adjacency) {
            if (is_usable(pair.lower) && is_usable(pair.upper)) {
                allow_copies(labels, pair);
            }
        }
        return labels;
    }

    void allow_copies(SplitLabels& labels, const AdjacentPair& pair) const {
        for (Label lower = 0; lower < originals_.size(); ++lower) {
            for (Label upper = 0; upper < originals_.size(); ++upper) {
                if (originals_[lower] == pair.lower && originals_[upper] == pair.upper) {
                    labels.allow(pair.axis, lower, upper);
                }
            }
        }
    }

    // Gives the cells of a label that have one of the others after them a label of their own. False
    // when these are all of its cells, or none.
    // `before` has the labels of cells that `label` and `after` are of.
    bool split(
        const std::vector<Label>& before, Label label, std::size_t axis, const LabelSet& after
    ) {
        std::vector<std::size_t> chosen;
        visit_neighbours(axis, [&](std::size_t index, std::size_t next) {
            if (before[index] == label && after.contains(before[next])) {
                chosen.push_back(index);
            }
        });
        const auto all = std::count(before.begin(), before.end(), label);
        if (chosen.empty() || chosen.size() == static_cast<std::size_t>(all)) {
            return false;
        }
        for (const std::size_t index : chosen) {
            cells_[index] = static_cast<Label>(originals_.size());
        }
        originals_.push_back(originals_[label]);
        has_split_ = true;
        return true;
    }

    // Where all squares can be closed, a cube may still be open: tells one of its labels apart by
    // what comes after it in the cube.
    ProofOutcome split_cube(const SplitLabels& labels, Work& work) {
        CubePairs cube;
        const ProofOutcome outcome = labels.find_open_cube(work, cube);
        if (outcome == ProofOutcome::kNotProved) {
            const std::vector<Label> before = cells_;
            static_cast<void>(std::any_of(cube.begin(), cube.end(), [&](const auto& pair) {
                LabelSet after(capacity_);
                after.insert(pair.after);
                return split(before, pair.label, pair.axis, after);
            }));
        }
        return outcome;
    }

    const Example& example_;
    const Transitions& transitions_;
    std::size_t capacity_;
    std::vector<Label> cells_;
    std::vector<Label> originals_;
    bool has_split_ = false;
};

}  // namespace

std::optional<SplitLabels> split_by_cells(
    const Example& example,
    const Transitions& transitions,
    std::size_t capacity,
    SplitOrder order,
    Work& work
) {
    return CellSplitter(example, transitions, capacity).run(order, work);
}

}  // namespace modelsynth::discrete
