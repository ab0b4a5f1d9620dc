#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/parameters.h"
#include "solver/core/label_set.h"
#include "solver/core/result.h"

#include <array>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

class Arrangement;
class ExampleReading;

// A model made before that another one of the same example starts from: only a part is made anew,
// all else keeps its figures.
struct Origin {
    std::array<double, 3> size = {};  // of that model, metres
    std::vector<Label> labels = {};   // of that model, by vertex
    std::array<double, 3> at = {};    // of the model to make, metres: where that one's corner lies
    // Of the model to make: what is made anew, besides what the origin does not cover. Without any
    // box, mask or voxels: nothing besides, or everything where the origin covers all.
    Region remade = {};
};

// What keeps a model with these parameters from starting there: that it does not hold all of the
// older one, or has no planes where that one has. Pointers are of a request.
// Requires: defaults filled in, find_faults() finds nothing.
[[nodiscard]] std::vector<Fault> find_origin_faults(
    const ExampleReading& reading, const Parameters& parameters, const Origin& origin
);

// Whether a model made with the earlier parameters has the planes that the origin of this one has,
// and ends as it does: in a larger one its sides have to be closed.
// Requires: find_origin_faults() finds nothing.
[[nodiscard]] bool has_planes_of(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Origin& origin,
    const Parameters& earlier
);

// What a model begins as that starts from another one.
struct Start {
    std::vector<Label> labels;          // by vertex: the older model's, kNoLabel beyond it
    std::vector<std::uint8_t> is_kept;  // by vertex: 1 where the label is to stay
};

// Requires: find_origin_faults() finds nothing. Fails: kInternal when the labels are not
// those of a model of that size; as Arrangement::make().
[[nodiscard]] Result<Start> place_origin(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Arrangement& arrangement,
    const Origin& origin,
    const std::stop_token& stop = {}
);

}  // namespace modelsynth::continuous
