#pragma once

// Private to the registry: the spaces of the solvers' models.

#include "solver/continuous/problem.h"
#include "solver/discrete/example.h"
#include "solver/registry/model_space.h"

#include <memory>

namespace modelsynth {

[[nodiscard]] std::shared_ptr<const ModelSpace> make_grid_space(
    std::shared_ptr<const discrete::Example> example, const GridSize& size
);

[[nodiscard]] std::shared_ptr<const ModelSpace> make_vertex_space(
    std::shared_ptr<const continuous::Problem> problem
);

}  // namespace modelsynth
