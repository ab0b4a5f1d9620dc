#pragma once

#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/topes.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// How far the planes of each family stand apart, so that figures of more than three families find
// places where planes of all of them meet (thesis 4.5.8).
struct Spacings {
    std::vector<double> of_family;  // metres; 0 for those that have planes of their own
    // What could not be had: families that should meet in one point, or along one line, but whose
    // spacings are no small multiples of each other. One sentence each.
    std::vector<std::string> conflicts;
};

// The families that take part in a dependent set of normals that one figure needs: where their
// planes lie is not free.
[[nodiscard]] FamilySet dependent_families(const Figures& figures);

// Minimal dependent sets of normals are asked for: where sum c_i n_i = 0 over a set that one
// figure needs, planes that pass through one point of a common lattice meet in every point of it
// when all |c_i| s_i are equal (Eq. 4.25 for every coefficient that is not 0), and in every few
// points when they are small multiples of each other.
// Families along the axes have the spacing asked for; others follow from them, the closest of what
// is asked; those that nothing is asked of have it, too. `fixed` has the spacing of families that
// the user gave, 0 for the others. `listed` families have planes of their own, wherever those
// are: nothing follows from them, nor do they from anything.
// Requires: spacing > 0, one fixed value per family. Cost: O(figures * families^4).
[[nodiscard]] Spacings solve_spacings(
    const Figures& figures, double spacing, std::span<const double> fixed, FamilySet listed = 0
);

}  // namespace modelsynth::continuous
