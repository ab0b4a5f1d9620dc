#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/surface/surface.h"
#include "solver/mesh/scene.h"
#include "tests/support/cone_cells.h"
#include "tests/support/surface_laws.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace modelsynth::testing {

// What is wrong with a model, one sentence each, the first few; nothing when all is right.
using ModelFaults = std::vector<std::string>;

// Re-verifies models of continuous synthesis from the example and the polygons alone, with none of
// the solver's families, figures or labels.
class SurfaceChecker {
  public:
    // Looks at the example as at a model: what stands around its special points is what may stand
    // around those of models.
    explicit SurfaceChecker(continuous::Example example);

    // `box`: what the model may fill.
    // The polygons are flat and simple, and look where faces of the example look, but for the
    // ground's where the box ends; each object's border is closed, encloses space once and leaves
    // it to no other; polygons are as large as they go, and meet only at corners; and around every
    // point everything stands so in the example. Of more than `points_max` points some are taken.
    // `cuts`: at which sides of the box objects may end that go on beyond; very near to those
    // nothing is looked at.
    [[nodiscard]] ModelFaults find_faults(
        const continuous::Surface& surface,
        const Eigen::AlignedBox3d& box,
        std::size_t points_max = 20'000,
        const CutSides& cuts = {}
    ) const;

    // A scene made from the surface: of each material the triangles are closed, cover as much as
    // the polygons, and look where their normals say.
    [[nodiscard]] ModelFaults find_faults(const Scene& scene, const continuous::Surface& surface)
        const;

    // The figures of the example, an object for every cell.
    [[nodiscard]] const std::set<std::string>& figures() const { return figures_; }

    [[nodiscard]] const ConeCells& cells() const { return cells_; }

  private:
    continuous::Example example_;
    ConeCells cells_;
    std::set<std::string> figures_;
};

}  // namespace modelsynth::testing
