#pragma once

#include "solver/examples/kit/mesh_builder.h"

namespace modelsynth::examples {

// The canyon's cell, metres: as wide as high, so that a level reads as a storey of rock.
inline constexpr float kCanyonCell = 3;
inline constexpr float kCanyonHalf = kCanyonCell / 2;
// Where ground lies above the floor of its cell: deep enough to sink a river bed into it.
inline constexpr float kCanyonGround = 0.5F;

// Sandstone at late noon: warm strata, and turquoise water against them.
struct CanyonPalette {
    MaterialId red;     // the main rock
    MaterialId orange;  // the softer rock between
    MaterialId cream;   // hard thin beds and the cap rock
    MaterialId dark;    // openings and the iron-stained bed
    MaterialId sand;    // the valley floor
    MaterialId grass;   // dry turf of the mesa tops
    MaterialId green;   // cacti, junipers
    MaterialId water;
    MaterialId wood;
};

}  // namespace modelsynth::examples
