#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/parameters.h"
#include "solver/core/result.h"

#include <span>
#include <vector>

namespace modelsynth::continuous {

// A shape that a request puts in the place of an object's boxes.
struct BoundingVolume {
    ObjectId object = 1;
    BoundingVolumeRule rule;

    friend bool operator==(const BoundingVolume&, const BoundingVolume&) = default;
};

// What parameters ask for of an example whose boxes are cut already, in the order of its objects.
// Objects it does not have are left to find_faults().
// Fails: kInvalidArgument, kTooLarge, with what find_shape_faults() says of the object's solids and
// the shape, at the constraint's place in the parameters; so when an object is asked for twice.
[[nodiscard]] Result<std::vector<BoundingVolume>> bounding_volumes_of(
    const Example& example, const Parameters& parameters
);

// A copy of the example with those in the place of its objects' own shapes, its boxes cut anew:
// objects keep their numbers, but for what is cut off boxes. Requires: bounding_volumes_of() gave
// them.
[[nodiscard]] Example with_bounding_volumes(
    const Example& example, std::span<const BoundingVolume> volumes
);

}  // namespace modelsynth::continuous
