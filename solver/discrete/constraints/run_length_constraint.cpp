#include "solver/discrete/constraints/run_length_constraint.h"

#include "solver/core/result.h"

namespace modelsynth::discrete {

namespace {

Direction positive(std::uint8_t axis) { return static_cast<Direction>(2 * axis); }

Direction negative(std::uint8_t axis) { return static_cast<Direction>(2 * axis + 1); }

}  // namespace

RunLengthConstraint::RunLengthConstraint(
    const GridSize& size, Periodic periodic, std::int32_t max, std::optional<std::uint8_t> axis
)
    : size_(size), periodic_(periodic), max_(max) {
    check(max >= 1, "runs of no length");
    if (axis) {
        first_axis_ = last_axis_ = *axis;
    }
}

void RunLengthConstraint::enter(const Members& /*members*/, std::span<const Site> /*inside*/) {
    is_fresh_ = true;
}

bool RunLengthConstraint::is_ring(std::uint8_t axis) const {
    return axis == 0 ? periodic_.x : axis == 1 ? periodic_.y : periodic_.z;
}

std::optional<Site> RunLengthConstraint::next(Site site, Direction direction) const {
    const Cell step = kDirectionSteps[static_cast<std::size_t>(direction)];
    const Cell cell = size_.cell(site);
    Cell to = {cell.x + step.x, cell.y + step.y, cell.z + step.z};
    if (periodic_.x) {
        to.x = (to.x + size_.x) % size_.x;
    }
    if (periodic_.y) {
        to.y = (to.y + size_.y) % size_.y;
    }
    if (periodic_.z) {
        to.z = (to.z + size_.z) % size_.z;
    }
    if (!size_.contains(to)) {
        return std::nullopt;
    }
    return static_cast<Site>(size_.index(to));
}

RunLengthConstraint::Run RunLengthConstraint::run_from(
    const Members& members, Site site, Direction direction
) const {
    Run run;
    for (auto at = next(site, direction); at && *at != site; at = next(*at, direction)) {
        if (members.at(*at) != Membership::kYes) {
            run.end = at;
            return run;
        }
        if (++run.length > max_) {
            return run;
        }
    }
    return run;
}

bool RunLengthConstraint::is_too_long(const Members& members, Site site, std::uint8_t axis) const {
    const Run ahead = run_from(members, site, positive(axis));
    if (!ahead.end && ahead.length <= max_ && is_ring(axis)) {
        return ahead.length + 1 > max_;  // once round
    }
    return ahead.length + 1 + run_from(members, site, negative(axis)).length > max_;
}

bool RunLengthConstraint::conclude(
    const Members& members, std::span<const Site> changed, Conclusions& conclusions
) {
    for (const Site site : changed) {
        const Membership membership = members.at(site);
        const bool asks = membership == Membership::kMaybe && is_fresh_;
        if (membership != Membership::kYes && !asks) {
            continue;
        }
        for (std::uint8_t axis = first_axis_; axis <= last_axis_; ++axis) {
            if (is_too_long(members, site, axis)) {
                if (!asks) {
                    return false;
                }
                conclusions.never.push_back(site);
            }
            if (asks) {
                continue;
            }
            for (const Direction direction : {positive(axis), negative(axis)}) {
                const auto end = run_from(members, site, direction).end;
                if (end && members.at(*end) == Membership::kMaybe &&
                    is_too_long(members, *end, axis)) {
                    conclusions.never.push_back(*end);
                }
            }
        }
    }
    is_fresh_ = false;
    return true;
}

}  // namespace modelsynth::discrete
