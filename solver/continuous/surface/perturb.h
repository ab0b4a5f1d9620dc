#pragma once

#include "solver/continuous/reading/topes.h"
#include "solver/continuous/surface/surface.h"

#include <vector>

namespace modelsynth::continuous {

// Moves faces along their normals by random amounts of at most `most` metres, so that what was in
// one row is in one no longer (thesis 4.8.1 regrets its neat rows). Three planes meet wherever they
// are: a corner of three faces follows them. Where more than three meet or come by, they are moved
// together, without turning, and faces that touch in one plane as one. Faces of firm objects and
// those in sides of the box stay, and so does what would leave the box, make an edge too short or
// go through another one. So every polygon stays flat and looks where it did, every border closed,
// and what touched touches. Deterministic: equal surfaces are moved equally. Cost: O(points * faces
// in a plane near them).
void perturb(
    Surface& surface,
    const Topes& topes,
    const Bounds& box,
    double most,
    const std::vector<bool>& is_firm
);

}  // namespace modelsynth::continuous
