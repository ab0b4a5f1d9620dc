#pragma once

#include "solver/discrete/analysis/success_curve.h"

#include <span>
#include <string>
#include <vector>

namespace modelsynth::discrete {

struct SuccessCurve {
    std::string name;  // of the example
    std::vector<SuccessPoint> points;
};

// The curves as an SVG drawing of 680 x 400 units in the manner of the thesis's Fig. 3.8: width of
// the model in cells to the right, share of runs that succeed in percent upwards; a thin bar
// through a point is where the true share lies with 95 % confidence (Wilson). Curves differ in
// colour, dashes and marks, of which there are six, and are named in a legend.
// One file that needs no other: no script, no font, no address to load from. It suits light and
// dark pages, as the reader's browser prefers.
// Requires: names in UTF-8; markup in them is escaped.
// Ensures: well-formed XML, equal for equal curves on any machine.
// Cost:    O(points). Thread-safe.
[[nodiscard]] std::string draw_success_curves(std::span<const SuccessCurve> curves);

}  // namespace modelsynth::discrete
