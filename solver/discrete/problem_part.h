#pragma once

#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"
#include "solver/core/relations.h"
#include "solver/discrete/problem.h"
#include "solver/discrete/symmetries.h"

namespace modelsynth::discrete {

// Calls task(const auto& part, const Relations&) with a box of the problem's models as a part of
// them, its images under the problem's symmetries included, and gives what that returns.
template <class Task>
auto with_part(const Problem& problem, const Box& box, Task task) {
    if (problem.symmetries != nullptr) {
        return task(problem.symmetries->close(box), problem.symmetries->relations());
    }
    return task(GridPart(problem.size, problem.periodic, box), problem.relations);
}

}  // namespace modelsynth::discrete
