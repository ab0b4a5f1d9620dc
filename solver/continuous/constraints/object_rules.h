#pragma once

#include "solver/continuous/constraints/coverage.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/reading/reading.h"
#include "solver/core/site_domains.h"

#include <bitset>
#include <string>
#include <vector>

namespace modelsynth::continuous {

using ObjectSet = std::bitset<kObjectTypesMax + 1>;

// The objects of some names, kEmptyName among them, with what is cut off them and their variants.
// Requires: the example has them.
[[nodiscard]] ObjectSet objects_named(
    const Example& example, const std::vector<std::string>& names
);

// The figures in which any of the objects takes part.
[[nodiscard]] LabelSet figures_of(const Figures& figures, const ObjectSet& objects);

// Takes from every vertex the figures that fixed, forbidden and probability 0 do not allow there:
// of a figure counts what it has in cells that lead into the region. What is forbidden is so below
// y = 0, too, under the region, unless it is the ground.
// Cost: O(vertices * rules), at the border of regions also * cells.
void narrow_to_regions(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Arrangement& arrangement,
    SiteDomains& domains
);

}  // namespace modelsynth::continuous
