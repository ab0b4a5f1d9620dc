#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/surface/surface.h"
#include "solver/mesh/scene.h"
#include "tests/support/cone_cells.h"
#include "tests/support/polygon_set.h"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::testing {

// Keeps the first few faults.
class FaultList {
  public:
    void add(std::string fault) {
        if (faults_.size() < kKept) {
            faults_.push_back(std::move(fault));
        }
    }

    [[nodiscard]] bool is_empty() const { return faults_.empty(); }

    [[nodiscard]] std::vector<std::string> take() { return std::move(faults_); }

  private:
    static constexpr std::size_t kKept = 10;

    std::vector<std::string> faults_;
};

// The laws that polygons obey by themselves, whatever stands where; see SurfaceChecker. Each adds
// what breaks one.

// Points and objects that do not exist, loops that are none. Without such faults the others may be
// looked for.
void find_invalid_numbers(
    const continuous::Example& example, const continuous::Surface& surface, FaultList& faults
);

// By side of a model's box, 2 * axis, + 1 where the coordinate is largest: whether it cuts objects
// that go on beyond.
using CutSides = std::array<bool, 6>;

void find_false_polygons(
    const continuous::Example& example,
    const ConeCells& cells,
    const PolygonSet& solids,
    const CutSides& cuts,
    FaultList& faults
);

// `polygons`: those of the surface, in its order.
void find_open_borders(
    const continuous::Surface& surface, const std::vector<SpacePolygon>& polygons, FaultList& faults
);

void find_corners_on_sides(const continuous::Surface& surface, FaultList& faults);

void check_scene(
    const continuous::Example& example,
    const Scene& scene,
    const std::vector<SpacePolygon>& polygons,
    FaultList& faults
);

}  // namespace modelsynth::testing
