#pragma once

#include "solver/continuous/example.h"

#include <cstdint>

namespace modelsynth::testing {

enum class SolidsKind : std::uint8_t {
    kBoxes,       // that touch and overlap
    kWedges,      // beside and on boxes
    kTetrahedra,  // with corners on a grid
    kConvex,      // of few half-spaces with small integers for normals
    kSlivers,     // of these and nearly coincident planes: mostly refused
};

inline constexpr int kSolidsKindCount = 5;

// A random example of a few solids of two object types, on a ground or not, cut off at bounds or
// not; the same for the same seed. Spacing 1, and a few metres large.
[[nodiscard]] continuous::Example make_random_solids(SolidsKind kind, std::uint32_t seed);

}  // namespace modelsynth::testing
