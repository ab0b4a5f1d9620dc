#pragma once

#include "solver/core/constraints/set_constraint.h"
#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"

#include <cstdint>
#include <vector>

namespace modelsynth::discrete {

// Any two members are at least `distance` steps along the axes apart (|dx| + |dy| + |dz|), the
// shorter way round where an axis is periodic.
// Cost: O(distance^3) for each site that is decided.
class SeparationConstraint final : public SetConstraint {
  public:
    // Requires: distance >= 1 (checked).
    SeparationConstraint(const GridSize& size, Periodic periodic, std::int32_t distance);

    void enter(const Members& members, std::span<const Site> inside) override;
    [[nodiscard]] bool conclude(
        const Members& members, std::span<const Site> changed, Conclusions& conclusions
    ) override;

  private:
    template <class Visit>
    void for_each_near(Site site, Visit visit) const;

    GridSize size_;
    Periodic periodic_;
    std::int32_t distance_;
    bool is_fresh_ = true;  // members outside have not been heard yet
};

}  // namespace modelsynth::discrete
