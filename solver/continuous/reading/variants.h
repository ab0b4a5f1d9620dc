#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/parameters.h"

#include <Eigen/Core>

#include <vector>

namespace modelsynth::continuous {

// What an example becomes by a turn about the upright axis or a reflection: an orthogonal matrix
// that leaves y, exact (parts are 0, 1 and -1).
using TurnMatrix = Eigen::Matrix3d;

// All that turns make of a model one after another, the unmoved one first: the group that they
// generate. Requires: it is finite.
[[nodiscard]] std::vector<TurnMatrix> group_of(const std::vector<TurnMatrix>& generators);

// All the ways an example is read, the unmoved one first: the group that the variants generate.
[[nodiscard]] std::vector<TurnMatrix> turns_of(const Variants& variants);

// The objects that cannot stay themselves when they are turned, by number in rising order: those
// with a dimension, which is across some planes and not across others, and with a shape, which
// looks its way. Requires: defaults filled in.
[[nodiscard]] std::vector<ObjectId> turned_apart(
    const Example& example, const Parameters& parameters
);

// The example with a further object type for each of `apart` and each turn but the first
// (ObjectType::variant_of), after those it has. Requires: it has none of those yet; there is room
// for them.
[[nodiscard]] Example with_variant_objects(
    Example example, const std::vector<TurnMatrix>& turns, const std::vector<ObjectId>& apart
);

// Its solids and bounds as a turn leaves them, each of the object it becomes.
[[nodiscard]] Example turned_solids(const Example& example, const TurnMatrix& turn);

}  // namespace modelsynth::continuous
