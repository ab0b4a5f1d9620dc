#include "solver/discrete/analysis/transitions.h"

#include "solver/core/grid.h"
#include "solver/core/result.h"
#include "solver/discrete/problem.h"

#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

bool allows_any(const Relations& relations, const LabelSet& labels, RelationId relation) {
    bool any = false;
    for_each_label(labels.words(), [&](Label near) {
        const auto row = relations.row(relation, near);
        for (std::size_t word = 0; word < row.size(); ++word) {
            any = any || (row[word] & labels.words()[word]) != 0;
        }
    });
    return any;
}

LabelSet find_labels(const Example& example) {
    std::vector<double> weights;
    for (const Piece& piece : example.pieces) {
        weights.push_back(piece.weight);
    }
    return usable_labels(example, weights);
}

}  // namespace

Transitions read_transitions(const Example& example) {
    return make_transitions(find_transitions(example), find_labels(example));
}

Transitions make_transitions(Relations relations, LabelSet labels) {
    check(relations.count() == kDirectionCount, "relations that are not those of a grid");
    check(labels.label_count() == relations.label_count(), "labels of other relations");
    Transitions transitions = {std::move(relations), std::move(labels), {}};
    for (std::size_t axis = 0; axis < transitions.open.size(); ++axis) {
        transitions.open[axis] = allows_any(
            transitions.relations, transitions.labels, static_cast<RelationId>(2 * axis)
        );
    }
    return transitions;
}

}  // namespace modelsynth::discrete
