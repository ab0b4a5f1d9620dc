#include "solver/continuous/triangulation/triangulation.h"

#include "solver/continuous/triangulation/bridges.h"
#include "solver/continuous/triangulation/ear_cutter.h"
#include "solver/continuous/triangulation/rings.h"

namespace modelsynth::continuous {

std::vector<std::array<std::uint32_t, 3>> triangulate(
    std::span<const Point2> points, const Loop& outer, std::span<const Loop> holes
) {
    Loop vertices = outer;
    for (const Loop& hole : holes) {
        vertices.insert(vertices.end(), hole.begin(), hole.end());
    }
    if (vertices.empty()) {
        return {};
    }
    rings::Places places;
    places.tolerance = rings::tolerance_for(points, vertices);
    const std::vector<std::uint32_t> place_of = rings::find_places(points, vertices, places);
    rings::Corners corners;
    std::span<const std::uint32_t> rest = place_of;
    const auto take = [&](const Loop& loop) {
        rings::add_ring(rest.first(loop.size()), corners);
        rest = rest.subspan(loop.size());
    };
    take(outer);
    for (const Loop& hole : holes) {
        take(hole);
    }
    rings::face_inside(places, corners);
    rings::bridge_holes(places, corners);
    return rings::cut_ears(places, corners);
}

}  // namespace modelsynth::continuous
