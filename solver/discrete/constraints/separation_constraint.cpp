#include "solver/discrete/constraints/separation_constraint.h"

#include "solver/core/result.h"

#include <algorithm>
#include <cstdlib>

namespace modelsynth::discrete {

namespace {

// Calls visit(coordinate, steps) once for every coordinate within `reach` steps of `at`.
template <class Visit>
void for_each_within(
    std::int32_t at, std::int32_t extent, bool periodic, std::int32_t reach, Visit visit
) {
    if (!periodic) {
        for (std::int32_t to = std::max(0, at - reach); to <= std::min(extent - 1, at + reach);
             ++to) {
            visit(to, std::abs(to - at));
        }
        return;
    }
    const std::int32_t back = std::min(reach, (extent - 1) / 2);
    const std::int32_t ahead = std::min(reach, extent / 2);
    for (std::int32_t step = -back; step <= ahead; ++step) {
        visit((at + step + extent) % extent, std::abs(step));
    }
}

}  // namespace

SeparationConstraint::SeparationConstraint(
    const GridSize& size, Periodic periodic, std::int32_t distance
)
    : size_(size), periodic_(periodic), distance_(distance) {
    check(distance >= 1, "a separation of no distance");
}

// Calls visit(Site) for every other site nearer than the distance.
template <class Visit>
void SeparationConstraint::for_each_near(Site site, Visit visit) const {
    const Cell centre = size_.cell(site);
    const std::int32_t reach = distance_ - 1;
    for_each_within(centre.y, size_.y, periodic_.y, reach, [&](std::int32_t y, std::int32_t dy) {
        for_each_within(
            centre.z,
            size_.z,
            periodic_.z,
            reach - dy,
            [&](std::int32_t z, std::int32_t dz) {
                for_each_within(
                    centre.x,
                    size_.x,
                    periodic_.x,
                    reach - dy - dz,
                    [&](std::int32_t x, std::int32_t) {
                        const auto near = static_cast<Site>(size_.index({x, y, z}));
                        if (near != site) {
                            visit(near);
                        }
                    }
                );
            }
        );
    });
}

void SeparationConstraint::enter(const Members& /*members*/, std::span<const Site> /*inside*/) {
    is_fresh_ = true;
}

bool SeparationConstraint::conclude(
    const Members& members, std::span<const Site> changed, Conclusions& conclusions
) {
    bool possible = true;
    for (const Site site : changed) {
        const Membership membership = members.at(site);
        if (membership == Membership::kYes) {
            for_each_near(site, [&](Site near) {
                possible = possible && members.at(near) != Membership::kYes;
                if (members.at(near) == Membership::kMaybe) {
                    conclusions.never.push_back(near);
                }
            });
        } else if (is_fresh_ && membership == Membership::kMaybe) {
            bool is_near = false;
            for_each_near(site, [&](Site near) {
                is_near = is_near || members.at(near) == Membership::kYes;
            });
            if (is_near) {
                conclusions.never.push_back(site);
            }
        }
        if (!possible) {
            return false;
        }
    }
    is_fresh_ = false;
    return true;
}

}  // namespace modelsynth::discrete
