#pragma once

#include "solver/core/label_set.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/analysis/work.h"

namespace modelsynth::discrete {

// Seven corners of a cube that leave no label for the eighth; each is named by the axes along which
// it is the farther.
struct OpenCube {
    Label origin = 0;
    Label x = 0;
    Label y = 0;
    Label z = 0;
    Label xy = 0;
    Label xz = 0;
    Label yz = 0;
};

// Eq. 3.11 of the thesis (3.3.7) as a test on the transition matrices: whether every corner can be
// closed. For any two axes, here x and y,
//
//     T_x(a, b) and T_y(a, c)  =>  there is a d with T_x(c, d) and T_y(b, d).
//
// (The thesis prints T_x for all four; its regions of 2 x 2 need it so.) The thesis is content with
// the plane and with that; for a proof two things more are asked for:
//   - every label has a label after it along every open axis, which begins each row;
//   - in space, any seven corners of a cube of which neighbours are allowed leave a label for the
//     eighth, the one farthest along all axes.
// Then a model of any size, its sides free, can be filled in any order in which a cell comes after
// the cells before it along each axis: what is filled can always be gone on with. Arc consistency
// never offers a label that the filled neighbours forbid, so Algorithm 3.1 does not fail.
//
// Where only a cube is in the way, `open_cube` is told of it, if it is given.
// Cost: O(labels^2) steps in the plane, O(labels^3) in space and much less as a rule. Thread-safe.
[[nodiscard]] ProofOutcome check_corners(
    const Transitions& transitions, Work& work, OpenCube* open_cube = nullptr
);

}  // namespace modelsynth::discrete
