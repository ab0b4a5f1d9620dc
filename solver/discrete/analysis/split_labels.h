#pragma once

#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

// A corner that cannot be closed (Eq. 3.11, thesis 3.3.7): any of `neighbours` may come after
// `label` along the axis `towards`, `excluded` may come after it along the axis `against`, and
// nothing may come after both of them. The label stands for things that have one or the other.
struct SplitConflict {
    Label label = 0;
    std::size_t towards = 0;
    LabelSet neighbours;
    std::size_t against = 0;
    Label excluded = 0;
};

// `after` may come after `label` along the axis.
struct NeighbourPair {
    Label label = 0;
    std::size_t axis = 0;
    Label after = 0;
};

// The neighbours in seven corners of a cube, those nearest its first corner first.
using CubePairs = std::array<NeighbourPair, 9>;

// Which of the two axes of a conflict comes first in it, where both would do.
enum class SplitOrder : std::uint8_t { kLowerAxisFirst, kHigherAxisFirst };

// Labels of which several may stand for the same label of an example, and which of them may be
// neighbours: the function f of Eq. 3.12 (thesis 3.3.8) is original(). Labels are numbered in the
// order they are added; those that were removed or merged keep their number and have no neighbours.
//
// A value; one that is not changed may be read from many threads.
class SplitLabels {
  public:
    // No labels yet, and never more than `capacity`.
    SplitLabels(const std::array<bool, 3>& open, std::size_t capacity);

    // The labels that may be used, each standing for itself, with their neighbours. The others are
    // there too, removed, so that numbers agree.
    SplitLabels(const Transitions& transitions, std::size_t capacity);

    // Requires: fewer labels than the capacity (checked), as copy() does.
    Label add(Label original);

    // A new label that stands for the same as `label`, and may stand wherever it may, next to it
    // too.
    Label copy(Label label);

    // `upper` after `lower` along the axis.
    void allow(std::size_t axis, Label lower, Label upper);
    void forbid(std::size_t axis, Label lower, Label upper);

    // `into` may stand wherever either might, and `label` is removed.
    void merge(Label label, Label into);

    // Removes labels that nothing may come after along an open axis, until there are none.
    void remove_ends();

    // Calls visit(const SplitConflict&) for the conflicts there are, until it returns true. Any two
    // neighbours of a label along two axes that cannot be closed are in one of them.
    // Returns kProved when there are no conflicts, kNoWork when the work is used up.
    // Cost: a step for every label and pair of axes.
    template <class Visit>
    ProofOutcome visit_conflicts(SplitOrder order, Work& work, const Visit& visit) const;

    // Where all three axes are open: seven corners of a cube that leave nothing for the eighth.
    // Requires: no label is an end, and there are no conflicts.
    // Returns kProved when there are none, kNotProved with `cube`, or kNoWork.
    ProofOutcome find_open_cube(Work& work, CubePairs& cube) const;

    [[nodiscard]] std::size_t count() const { return originals_.size(); }

    [[nodiscard]] std::size_t capacity() const { return present_.label_count(); }

    [[nodiscard]] const LabelSet& present() const { return present_; }

    [[nodiscard]] Label original(Label label) const { return originals_[label]; }

    [[nodiscard]] const std::array<bool, 3>& open() const { return open_; }

    [[nodiscard]] const LabelSet& after(std::size_t axis, Label label) const {
        return after_[axis][label];
    }

    [[nodiscard]] const LabelSet& before(std::size_t axis, Label label) const {
        return before_[axis][label];
    }

    // The labels that are not removed, numbered anew in their order, and what each stands for.
    [[nodiscard]] Transitions transitions() const;
    [[nodiscard]] std::vector<Label> originals() const;

    // What they stand for, as a set of `original_count` labels.
    [[nodiscard]] LabelSet covered(std::size_t original_count) const;

  private:
    // For every label, the labels that can be closed with it: those for which something may
    // come after the former along `towards` and after the latter along `against`.
    [[nodiscard]] std::vector<LabelSet> closing(std::size_t towards, std::size_t against) const;

    // The pairs of open axes, in each the one to split along first.
    [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> axis_pairs(SplitOrder order
    ) const;

    // Empty at once where nothing is left, which is the usual case.
    [[nodiscard]] static LabelSet without(const LabelSet& set, const LabelSet& others);

    void remove(Label label);

    std::array<bool, 3> open_;
    LabelSet present_;
    std::vector<Label> originals_;
    std::array<std::vector<LabelSet>, 3> after_;   // [axis][label]
    std::array<std::vector<LabelSet>, 3> before_;  // [axis][label]
};

template <class Visit>
ProofOutcome SplitLabels::visit_conflicts(SplitOrder order, Work& work, const Visit& visit) const {
    bool has_any = false;
    for (const auto& [towards, against] : axis_pairs(order)) {
        const std::vector<LabelSet> closing = this->closing(towards, against);
        for (Label label = 0; label < count(); ++label) {
            if (!present_.contains(label)) {
                continue;
            }
            if (!work.take()) {
                return ProofOutcome::kNoWork;
            }
            bool is_done = false;
            for_each_label(after(against, label).words(), [&](Label excluded) {
                if (is_done) {
                    return;
                }
                LabelSet open = without(after(towards, label), closing[excluded]);
                if (!open.empty()) {
                    has_any = true;
                    is_done =
                        visit(SplitConflict{label, towards, std::move(open), against, excluded});
                }
            });
            if (is_done) {
                return ProofOutcome::kNotProved;
            }
        }
    }
    return has_any ? ProofOutcome::kNotProved : ProofOutcome::kProved;
}

}  // namespace modelsynth::discrete
