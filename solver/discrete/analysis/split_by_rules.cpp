#include "solver/discrete/analysis/split_by_rules.h"

#include <optional>
#include <utility>

namespace modelsynth::discrete {

namespace {

// Whether a conflict is settled by forbidding pairs alone: all that may come after the label on
// one of the axes takes part in it.
bool is_settled_by_forbidding(const SplitLabels& labels, const SplitConflict& conflict) {
    return labels.after(conflict.towards, conflict.label) == conflict.neighbours ||
           labels.after(conflict.against, conflict.label).count() == 1;
}

void forbid_pairs(SplitLabels& labels, const SplitConflict& conflict) {
    if (labels.after(conflict.towards, conflict.label) == conflict.neighbours) {
        labels.forbid(conflict.against, conflict.label, conflict.excluded);
        return;
    }
    for_each_label(conflict.neighbours.words(), [&](Label neighbour) {
        labels.forbid(conflict.towards, conflict.label, neighbour);
    });
}

// Makes a twin of the label that comes before these, and leaves the label before all others.
Label split(SplitLabels& labels, Label label, std::size_t axis, const LabelSet& neighbours) {
    const Label twin = labels.copy(label);
    const LabelSet after = labels.after(axis, label);
    for_each_label(after.words(), [&](Label next) {
        // Either of the two may itself be what comes after.
        const bool is_chosen = neighbours.contains(next == twin ? label : next);
        labels.forbid(axis, is_chosen ? label : twin, next);
    });
    return twin;
}

void split(SplitLabels& labels, const SplitConflict& conflict) {
    const Label twin = split(labels, conflict.label, conflict.towards, conflict.neighbours);
    labels.forbid(conflict.against, twin, conflict.excluded);
    if (conflict.excluded == conflict.label) {
        labels.forbid(conflict.against, twin, twin);
    }
}

// Tells one label of an open cube apart by what comes after it. Where all of them have one
// label after them, the cube is all there is to the first one, which no model goes on from. False
// when that takes more labels than there may be.
bool settle(SplitLabels& labels, const CubePairs& cube) {
    for (const NeighbourPair& pair : cube) {
        if (labels.after(pair.axis, pair.label).count() == 1) {
            continue;
        }
        if (labels.count() == labels.capacity()) {
            return false;
        }
        LabelSet after(labels.capacity());
        after.insert(pair.after);
        split(labels, pair.label, pair.axis, after);
        return true;
    }
    labels.forbid(cube[0].axis, cube[0].label, cube[0].after);
    return true;
}

}  // namespace

ProofOutcome split_by_rules(SplitLabels& labels, SplitOrder order, Work& work) {
    for (;;) {
        labels.remove_ends();
        // Forbidding pairs first keeps the number of labels down.
        std::optional<SplitConflict> found;
        bool is_forbidding = false;
        const ProofOutcome outcome =
            labels.visit_conflicts(order, work, [&](SplitConflict conflict) {
                is_forbidding = is_settled_by_forbidding(labels, conflict);
                if (is_forbidding || !found) {
                    found = std::move(conflict);
                }
                return is_forbidding;
            });
        if (outcome == ProofOutcome::kNoWork) {
            return outcome;
        }
        if (outcome == ProofOutcome::kProved) {
            CubePairs cube;
            const ProofOutcome cubes = labels.find_open_cube(work, cube);
            if (cubes != ProofOutcome::kNotProved || !settle(labels, cube)) {
                return cubes;
            }
        } else if (is_forbidding) {
            forbid_pairs(labels, *found);
        } else if (labels.count() < labels.capacity()) {
            split(labels, *found);
        } else {
            return ProofOutcome::kNotProved;
        }
    }
}

}  // namespace modelsynth::discrete
