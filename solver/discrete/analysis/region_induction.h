#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"

#include <array>

namespace modelsynth::discrete {

// The automated induction of the thesis (3.3.7, Theorem 3.3.6, Algorithms 3.6 and 3.7): tries to
// prove that Algorithm 3.1 cannot fail by looking at regions of a small size only.
//
// What is proved: in a model of any size with at least two cells along every open axis, all sides
// free, labelled in the order of column_order() (x outermost, then z, then y, each upwards), every
// label that the catalog offers for the next cell leads on to a complete model. Nothing is
// said of other orders, of fixed cells and sides, or of blocks in a model that stands.
//
// How: let the windows of a model be all boxes in it of the region's size, or of the model's extent
// where that is smaller. A window is alive when its cells that are labelled so far leave every
// cell of it a label by arc consistency within the window alone (C_R of the thesis).
//   Start: a window without labels is alive. (If not, then no model of these sizes exists, and
//          the catalog of the whole is empty before the first choice.)
//   Step:  all windows are alive and p is the next cell. R is the window that begins one cell
//          before p along each axis, moved into the model where it would stick out (Algorithm 3.7).
//          Take any label of C_R at p, and any other window with p in it: with that label it is
//          still alive. This is what is checked, for every state R can have, every state the
//          other window can have that agrees with it where they overlap, and every label.
//   End:   all windows are full and alive, so all neighbours in the model are allowed.
// The catalog of the whole is within C_R (Eq. 3.10), so Algorithm 3.1 makes no other choices.
// The thesis leaves aside what happens at the sides; moving windows into the model is what makes
// regions as good there, and makes extents below the region's a case of their own.
//
// Requires: extents of `region` >= 2 along open axes, 1 along the others (checked).
// Cost: up to labels^cells states of each window, a step each. Memory: one set for every
//       labelling of an overlap. Thread-safe.
[[nodiscard]] ProofOutcome prove_by_region(
    const Transitions& transitions, const GridSize& region, Work& work
);

// The smallest region there is: two cells along every open axis.
[[nodiscard]] GridSize smallest_region(const std::array<bool, 3>& open);

}  // namespace modelsynth::discrete
