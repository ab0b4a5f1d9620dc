#pragma once

#include "solver/core/grid_topology.h"
#include "solver/core/label_weights.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"
#include "solver/core/site_domains.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <cstdint>
#include <string>
#include <vector>

namespace modelsynth::discrete {

// The transition matrices T_x, T_y, T_z of the example (Eq. 3.2) and their transposes: a relation
// per direction. Exactly the pairs that stand in the example, and those listed in `adjacency`.
[[nodiscard]] Relations find_transitions(const Example& example);

// Everything wrong with parameters that are well-formed by themselves, against this example:
// unknown pieces, cells outside the model, sides that cannot go together. Pointers are relative
// to `parameters`. Empty: nothing wrong.
// Requires: defaults filled in.
[[nodiscard]] std::vector<Fault> find_faults(const Example& example, const Parameters& parameters);

// A request as the search sees it.
struct Problem {
    GridSize size;
    Periodic periodic;
    Relations relations;
    SiteDomains domains;  // boundary, fixed and forbidden cells, removed pieces
    LabelWeights weights;
};

// Requires: find_faults() found nothing (checked).
// Fails:    kContradiction when some cell can take no piece at all; the message names the sides.
[[nodiscard]] Result<Problem> make_problem(const Example& example, const Parameters& parameters);

// "tower", "wall" and "gate": names of pieces as a person reads them, at most eight.
[[nodiscard]] std::string list_names(const Example& example, const LabelSet& labels);

// The sides of a grid that a cell lies on: "the bottom and north sides"; empty: none.
[[nodiscard]] std::string name_sides(const GridSize& size, const Cell& cell);

}  // namespace modelsynth::discrete
