#pragma once

#include "solver/core/constraints/set_constraint.h"
#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"

#include <cstdint>
#include <optional>

namespace modelsynth::discrete {

// No more than `max` members follow each other in a straight line: along one axis, or along any.
// A ring of members round a periodic axis counts with its length.
// Cost: O(max) for each site that is decided and each axis.
class RunLengthConstraint final : public SetConstraint {
  public:
    // `axis`: 0 x, 1 y, 2 z; none: all three. Requires: max >= 1 (checked).
    RunLengthConstraint(
        const GridSize& size, Periodic periodic, std::int32_t max, std::optional<std::uint8_t> axis
    );

    void enter(const Members& members, std::span<const Site> inside) override;
    [[nodiscard]] bool conclude(
        const Members& members, std::span<const Site> changed, Conclusions& conclusions
    ) override;

  private:
    struct Run {
        std::int32_t length = 0;
        std::optional<Site>
            end;  // the site after it; none: the model's side, or the run is too long
    };

    // The members that follow the site in the direction, no more than max + 1.
    [[nodiscard]] Run run_from(const Members& members, Site site, Direction direction) const;
    [[nodiscard]] bool is_ring(std::uint8_t axis) const;
    [[nodiscard]] std::optional<Site> next(Site site, Direction direction) const;
    // Whether a member at the site would make a run too long along the axis.
    [[nodiscard]] bool is_too_long(const Members& members, Site site, std::uint8_t axis) const;

    GridSize size_;
    Periodic periodic_;
    std::int32_t max_;
    std::uint8_t first_axis_ = 0;
    std::uint8_t last_axis_ = 2;
    bool is_fresh_ = true;  // members outside have not been heard yet
};

}  // namespace modelsynth::discrete
