#include "solver/continuous/planes/vertex_finder.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

constexpr double kSameVertex = 1e-6;  // cells

}  // namespace

Site VertexFinder::at(const Point& place) const {
    const Arrangement::Frame& frame = arrangement_.frame();
    const double tolerance = kSameVertex * frame.cell;
    const auto cell_of = [&](double along, std::int32_t count) {
        const double cell = std::floor(along / frame.cell);
        return static_cast<std::int32_t>(std::clamp(cell, 0.0, count - 1.0));
    };
    const auto low = [&](int axis, std::int32_t count) {
        return cell_of(place[axis] - tolerance, count);
    };
    const auto high = [&](int axis, std::int32_t count) {
        return cell_of(place[axis] + tolerance, count) + 1;
    };
    const Box cells = {
        {low(0, frame.cells.x), low(1, frame.cells.y), low(2, frame.cells.z)},
        {high(0, frame.cells.x), high(1, frame.cells.y), high(2, frame.cells.z)}};
    Site found = kNoSite;
    arrangement_.for_each_vertex(cells, [&](Site site) {
        if ((arrangement_.position(site) - place).cwiseAbs().maxCoeff() < tolerance) {
            found = site;
        }
    });
    return found;
}

}  // namespace modelsynth::continuous
