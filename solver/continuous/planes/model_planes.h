#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/planes/spacing.h"
#include "solver/continuous/reading/reading.h"

#include <cstdint>
#include <vector>

namespace modelsynth::continuous {

// Where the planes of a model lie: equally spaced ones through one point, or those of a list. The
// point is the origin, or where a reflection or turn asks for that, on the line that they are
// about.
struct ModelPlanes {
    Spacings spacings;
    // By family, inside of the box.
    std::vector<PlaneOffsets> offsets;
    // By family, the number of the first of these: the plane through that point is number 0, or
    // the first one of the list, be it inside of the box or not. The others follow.
    std::vector<std::int64_t> first_number;
};

// The box of a model: its size, and with a ground some space below it; a free side is a little
// nearer, so that no plane lies in it.
[[nodiscard]] Bounds model_box(const ExampleReading& reading, const Parameters& parameters);

// That in which planes are laid: at free sides they go on beyond the model, so that whatever
// crosses one of its sides has vertices on both.
[[nodiscard]] Bounds arranged_box(const ExampleReading& reading, const Parameters& parameters);

// From where to where the box reaches across planes of a normal.
struct Reach {
    double low = 0;
    double high = 0;
};

[[nodiscard]] Reach reach_along(const Point& normal, const Bounds& box);

// Requires of all of these: defaults filled in, every normal is that of a family of the example.

// Families of which the planes are listed.
[[nodiscard]] FamilySet listed_families(
    const ExampleReading& reading, const Parameters& parameters
);

[[nodiscard]] Spacings spacings_of(const ExampleReading& reading, const Parameters& parameters);

// With a ground, one plane is that of the ground, whether it is listed or not.
// Requires: find_faults() finds nothing, which bounds how many planes there are.
[[nodiscard]] ModelPlanes make_planes(const ExampleReading& reading, const Parameters& parameters);

}  // namespace modelsynth::continuous
