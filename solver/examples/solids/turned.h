#pragma once

#include "solver/continuous/example.h"

namespace modelsynth::examples {

// What a solver has not seen turned it does not turn: these turn a piece that is written once.

// A quarter turn about the upright line through the origin, counter-clockwise seen from above: east
// becomes north, that is +x becomes -z. Exact.
[[nodiscard]] continuous::Point turned(const continuous::Point& point, int quarters);
[[nodiscard]] continuous::Polyhedron turned(continuous::Polyhedron solid, int quarters);

// The axes change places: x becomes y, y becomes z and z becomes x, so many times. Exact.
[[nodiscard]] continuous::Polyhedron rolled(continuous::Polyhedron solid, int times);

}  // namespace modelsynth::examples
