#pragma once

#include "solver/continuous/example.h"
#include "solver/core/result.h"

#include <cstddef>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// What an example may have. Coordinates of corners in metres, to either side of 0.
inline constexpr std::size_t kPolyhedraMax = 4096;
inline constexpr std::size_t kFacesMax = 20000;        // of all polyhedra
inline constexpr std::size_t kCornersOfFaceMax = 256;  // of one face
inline constexpr std::size_t kCornersMax = 200'000;    // of all faces, and of all polyhedra
inline constexpr double kCoordinateMax = 1e5;
inline constexpr std::size_t kSolidFaultsMax = 50;

// What is wrong with the solids of an example that comes from a user, broken or hostile: at most
// kSolidFaultsMax faults in the order of the polyhedra; none if every polyhedron is a closed solid.
//
// Checked:  limits (faults that are over_limit), object and material numbers, bounds and
//           dimensions; finite places; three different corners or more a face, four faces or more
//           a polyhedron; every edge of a face is once an edge of another, the other way round; the
//           faces look outwards; no face crosses itself or another of its polyhedron.
// Not:      flat faces with an area and how many directions they have (find_families()). Solids
//           may overlap others, and may touch themselves.
// Faults:   pointers are relative to the example: /polyhedra/3/faces/7, /polyhedra/3/corners/2,
//           /objects/1/material. Places in metres.
// Cost:     20000 faces take some tens of milliseconds, and the worst within the limits about a
//           second. Thread-safe.
[[nodiscard]] std::vector<Fault> find_solid_faults(const Example& example);

// A place as faults name it: "(1.5, 0, -2) m".
[[nodiscard]] std::string place_text(const Point& point);

}  // namespace modelsynth::continuous
