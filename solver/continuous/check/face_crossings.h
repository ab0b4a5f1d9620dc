#pragma once

#include "solver/continuous/example.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace modelsynth::continuous {

// Two faces of a solid that go through each other, or lie on top of each other.
struct FaceCrossing {
    std::uint32_t first = 0;  // the smaller number
    std::uint32_t second = 0;
    Point place = Point::Zero();  // where, metres
    bool is_overlap = false;      // in one plane, and looking the same way
};

// How many pairs of faces may be looked at, in corners visited. A hostile solid is one whose faces
// are all near each other; an honest one of 20000 faces takes some millions.
inline constexpr std::size_t kCrossingWorkMax = 50'000'000;

// Pairs of faces of a solid that cross, ordered by their numbers; of more than `count_max` (at
// least 1) any so many. Faces that touch at a corner or an edge, that end on each other, or that
// lie on each other looking opposite ways do not cross. Faces that are not flat, or have no area,
// are left out: those are errors of their own. A solid that goes through one of its faces with an
// edge exactly in its plane is not found.
//
// Requires: three or more corners a face, numbers in range, finite places. Corners closer than
// `tolerance`
//           (metres) to a plane lie in it.
// Fails: nothing when more than `work` would be needed; it is counted down.
// Cost: a sweep, O(faces * faces side by side), and O(corners) for every two whose boxes meet.
// Thread-safe.
[[nodiscard]] std::optional<std::vector<FaceCrossing>> find_crossings(
    const Polyhedron& solid, double tolerance, std::size_t count_max, std::size_t& work
);

}  // namespace modelsynth::continuous
