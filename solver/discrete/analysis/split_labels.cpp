#include "solver/discrete/analysis/split_labels.h"

#include "solver/core/grid.h"
#include "solver/core/result.h"
#include "solver/discrete/analysis/corner_condition.h"

#include <algorithm>

namespace modelsynth::discrete {

SplitLabels::SplitLabels(const std::array<bool, 3>& open, std::size_t capacity)
    : open_(open), present_(capacity) {}

SplitLabels::SplitLabels(const Transitions& transitions, std::size_t capacity)
    : SplitLabels(transitions.open, capacity) {
    const Relations& relations = transitions.relations;
    for (std::size_t label = 0; label < relations.label_count(); ++label) {
        add(static_cast<Label>(label));
    }
    for (Label label = 0; label < relations.label_count(); ++label) {
        if (!transitions.labels.contains(label)) {
            present_.erase(label);
            continue;
        }
        for (std::size_t axis = 0; axis < open_.size(); ++axis) {
            for_each_label(
                relations.row(static_cast<RelationId>(2 * axis), label),
                [&](Label upper) {
                    if (transitions.labels.contains(upper)) {
                        allow(axis, label, upper);
                    }
                }
            );
        }
    }
}

Label SplitLabels::add(Label original) {
    check(count() < capacity(), "more labels than a split was made for");
    const auto label = static_cast<Label>(count());
    originals_.push_back(original);
    present_.insert(label);
    for (std::size_t axis = 0; axis < open_.size(); ++axis) {
        after_[axis].emplace_back(capacity());
        before_[axis].emplace_back(capacity());
    }
    return label;
}

Label SplitLabels::copy(Label label) {
    const Label twin = add(originals_[label]);
    for (std::size_t axis = 0; axis < open_.size(); ++axis) {
        const bool is_self_adjacent = after_[axis][label].contains(label);
        const LabelSet after = after_[axis][label];
        const LabelSet before = before_[axis][label];
        for_each_label(after.words(), [&](Label upper) { allow(axis, twin, upper); });
        for_each_label(before.words(), [&](Label lower) { allow(axis, lower, twin); });
        if (is_self_adjacent) {
            allow(axis, twin, twin);
        }
    }
    return twin;
}

void SplitLabels::allow(std::size_t axis, Label lower, Label upper) {
    after_[axis][lower].insert(upper);
    before_[axis][upper].insert(lower);
}

void SplitLabels::forbid(std::size_t axis, Label lower, Label upper) {
    after_[axis][lower].erase(upper);
    before_[axis][upper].erase(lower);
}

void SplitLabels::merge(Label label, Label into) {
    const auto renamed = [label, into](Label other) { return other == label ? into : other; };
    for (std::size_t axis = 0; axis < open_.size(); ++axis) {
        const LabelSet after = after_[axis][label];
        const LabelSet before = before_[axis][label];
        for_each_label(after.words(), [&](Label upper) { allow(axis, into, renamed(upper)); });
        for_each_label(before.words(), [&](Label lower) { allow(axis, renamed(lower), into); });
    }
    remove(label);
}

void SplitLabels::remove_ends() {
    const auto is_end = [this](Label label) {
        for (std::size_t axis = 0; axis < open_.size(); ++axis) {
            if (open_[axis] && after_[axis][label].empty()) {
                return true;
            }
        }
        return false;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (Label label = 0; label < count(); ++label) {
            if (present_.contains(label) && is_end(label)) {
                remove(label);
                changed = true;
            }
        }
    }
}

LabelSet SplitLabels::without(const LabelSet& set, const LabelSet& others) {
    LabelSet rest;
    for (std::size_t word = 0; word < set.words().size(); ++word) {
        if ((set.words()[word] & ~others.words()[word]) != 0) {
            rest = set;
            break;
        }
    }
    for_each_label(rest.words(), [&](Label label) {
        if (others.contains(label)) {
            rest.erase(label);
        }
    });
    return rest;
}

void SplitLabels::remove(Label label) {
    present_.erase(label);
    for (std::size_t axis = 0; axis < open_.size(); ++axis) {
        const LabelSet after = after_[axis][label];
        const LabelSet before = before_[axis][label];
        for_each_label(after.words(), [&](Label upper) { forbid(axis, label, upper); });
        for_each_label(before.words(), [&](Label lower) { forbid(axis, lower, label); });
    }
}

ProofOutcome SplitLabels::find_open_cube(Work& work, CubePairs& cube) const {
    if (std::count(open_.begin(), open_.end(), true) < 3) {
        return ProofOutcome::kProved;
    }
    OpenCube found;
    const ProofOutcome outcome = check_corners(transitions(), work, &found);
    if (outcome == ProofOutcome::kNotProved) {
        const auto& [origin, x, y, z, xy, xz, yz] = found;
        cube = {
            {{origin, 0, x},
             {origin, 1, y},
             {origin, 2, z},
             {x, 1, xy},
             {x, 2, xz},
             {y, 0, xy},
             {y, 2, yz},
             {z, 0, xz},
             {z, 1, yz}}};
        std::vector<Label> labels;  // by their numbers in the transitions
        for_each_label(present_.words(), [&](Label label) { labels.push_back(label); });
        for (NeighbourPair& pair : cube) {
            pair = {labels[pair.label], pair.axis, labels[pair.after]};
        }
    }
    return outcome;
}

std::vector<LabelSet> SplitLabels::closing(std::size_t towards, std::size_t against) const {
    std::vector<LabelSet> sets(count(), LabelSet(capacity()));
    for_each_label(present_.words(), [&](Label label) {
        for_each_label(after(towards, label).words(), [&](Label last) {
            sets[label] |= before(against, last);
        });
    });
    return sets;
}

std::vector<std::pair<std::size_t, std::size_t>> SplitLabels::axis_pairs(SplitOrder order) const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t lower = 0; lower < open_.size(); ++lower) {
        for (std::size_t higher = lower + 1; higher < open_.size(); ++higher) {
            if (open_[lower] && open_[higher]) {
                pairs.push_back(
                    order == SplitOrder::kLowerAxisFirst ? std::pair(lower, higher)
                                                         : std::pair(higher, lower)
                );
            }
        }
    }
    return pairs;
}

Transitions SplitLabels::transitions() const {
    std::vector<Label> number(count(), kNoLabel);
    Label next = 0;
    for_each_label(present_.words(), [&](Label label) { number[label] = next++; });
    Relations relations(next, {1, 0, 3, 2, 5, 4});
    for_each_label(present_.words(), [&](Label label) {
        for (std::size_t axis = 0; axis < open_.size(); ++axis) {
            for_each_label(after(axis, label).words(), [&](Label upper) {
                relations.allow(static_cast<RelationId>(2 * axis), number[label], number[upper]);
            });
        }
    });
    return make_transitions(std::move(relations), LabelSet::all(next));
}

std::vector<Label> SplitLabels::originals() const {
    std::vector<Label> list;
    for_each_label(present_.words(), [&](Label label) { list.push_back(originals_[label]); });
    return list;
}

LabelSet SplitLabels::covered(std::size_t original_count) const {
    LabelSet set(original_count);
    for_each_label(present_.words(), [&](Label label) { set.insert(originals_[label]); });
    return set;
}

}  // namespace modelsynth::discrete
