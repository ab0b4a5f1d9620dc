#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/example.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/reading/reading.h"

#include <utility>
#include <vector>

namespace modelsynth::continuous {

// Pairs of names as objects. Requires: the example has them, or they are kEmptyName.
[[nodiscard]] std::vector<std::pair<Label, Label>> object_pairs(
    const Example& example, const NamePairs& names
);

// Which objects become which, so that as many figures of the example as can be found have images
// in it: corners of the left become those of the right. The objects that are not named stay.
// Pairs are exchanged, the best first, as long as that helps. Requires: every family has an image.
// Cost: objects * figures * topes, times the passes, which are few; bounded.
[[nodiscard]] NamePairs likely_mirror(const ExampleReading& reading, const SymmetryRule& rule);

// Gives symmetries that name no images those of likely_mirror(), where every family has an image.
void fill_mirrors(const ExampleReading& reading, Parameters& parameters);

// The image of every figure, kNoLabel where the example has no such figure; objects are moved as
// the rule says, or by likely_mirror(). Requires: every family has an image.
[[nodiscard]] std::vector<Label> figure_images(
    const ExampleReading& reading, const SymmetryRule& rule
);

}  // namespace modelsynth::continuous
