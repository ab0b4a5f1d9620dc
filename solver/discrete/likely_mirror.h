#pragma once

#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

namespace modelsynth::discrete {

// Which pieces become which under a symmetry's motion, so that as many pairs of neighbours of the
// example as can be found have images that are neighbours in it, too (2007 paper, 4.1), and as few
// pieces as possible lose the side of the model that they may stand on. The search begins with what
// pieces look like once moved, by their meshes; what is drawn does not become what is not.
// Shape:    every piece that is not its own image, with its image.
// Ensures:  a one-to-one map that comes back to itself as the cells do: no fault. Nothing for a
//           translation. The same map for the same example, of which it depends alone.
// Requires: the example's boundary names pieces that it has.
// Cost:     O(cells), and a bounded number of looks at pairs: some tenths of a second for thousands
//           of pieces, hundredths for a hundred.
[[nodiscard]] NamePairs likely_mirror(const Example& example, Symmetry::Kind kind);

// Gives symmetries that name no images those of likely_mirror().
void fill_mirrors(const Example& example, Parameters& parameters);

}  // namespace modelsynth::discrete
