#pragma once

#include "solver/discrete/analysis/split_labels.h"
#include "solver/discrete/analysis/work.h"

namespace modelsynth::discrete {

// Splits labels by what comes after them, until every corner can be closed (Eq. 3.11, and in
// space the corners of cubes), without losing models. Of a conflict (see split_labels.h), the
// label's copies are those before one of `neighbours`, and the others; the first cannot have
// `excluded` after them along the other axis, since nothing would close the corner.
//
// What is kept: a model of the labels as they were is f of one of the labels as they are, if it is
// a part of a model that goes on far enough beyond its far sides (at most one cell along every axis
// for each split, each pair forbidden and each label removed). Each cell's copy is given by the
// cells after it; a pair is forbidden, and a label removed, only where no model goes on. So in
// unbounded models Eq. 3.13 holds as it stands. What is lost are models that can only end at a far
// side.
//
// Returns kProved when no conflict is left (no label at all is left where no model goes on for
// ever), kNotProved when the labels' capacity is used up, which is so where no number of
// labels is enough, and kNoWork. Labels that are not wanted may be split then, but what is kept
// holds. Cost: a step for each label and pair of axes, times the number of changes.
[[nodiscard]] ProofOutcome split_by_rules(SplitLabels& labels, SplitOrder order, Work& work);

}  // namespace modelsynth::discrete
