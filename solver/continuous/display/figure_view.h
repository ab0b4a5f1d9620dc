#pragma once

#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/topes.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// A place in a picture: to the right and upwards; the figure's point is at 0, 0, and the cube's
// half-edges have length 1.
using Place = std::array<double, 2>;
using Stroke = std::pair<Place, Place>;

// Where one looks from, without perspective: right of the front and above, or the opposite. Each
// side of a cube is seen from one of these.
enum class ViewFrom : std::uint8_t { kFront, kBack };

// To the viewer, of unit length; upwards is upwards in both pictures.
[[nodiscard]] Point direction_to_viewer(ViewFrom from);
[[nodiscard]] Place place_of(const Point& point, ViewFrom from);

// A convex piece of an object's surface, or of where the cube's sides cut through an object.
struct FigurePiece {
    ObjectId object = kEmpty;
    Point normal = Point::UnitY();
    std::vector<Place> outline;
    std::vector<Stroke> edges;  // parts of the outline where the surface bends, ends or changes
};

// What stands around a point within the cube [-1, 1]^3.
struct FigureView {
    std::vector<FigurePiece>
        surfaces;                   // from back to front: what comes later hides what came before
    std::vector<FigurePiece> cuts;  // the cube's sides towards the viewer: in front of all that
    std::vector<Stroke> edges;      // of all surfaces and between objects, hidden ones, too
    bool is_point_hidden = false;   // the middle of the cube
};

// The cube is cut by the planes of the families that matter to the figure, all of which pass
// through its middle. A line of sight comes from behind each of these planes to its front and never
// back, so cells with more planes behind them are in front of cells with fewer: that order is
// right for any two cells (and there is one for every arrangement of planes).
// Cost: of r families that matter O(r^3), for the r (r - 1) + 2 cells at most, times the corners of
//       a cell. Thread-safe.
[[nodiscard]] FigureView view_figure(
    const Topes& topes, const Figure& figure, FamilySet relevant, ViewFrom from
);

// The edges of the cube: three behind all that is in it, and nine others.
struct CubeEdges {
    std::vector<Stroke> behind;
    std::vector<Stroke> rest;
};

[[nodiscard]] CubeEdges cube_edges(ViewFrom from);

}  // namespace modelsynth::continuous
