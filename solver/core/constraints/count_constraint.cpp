#include "solver/core/constraints/count_constraint.h"

namespace modelsynth {

void CountConstraint::enter(const Members& /*members*/, std::span<const Site> inside) {
    inside_.assign(inside.begin(), inside.end());
}

bool CountConstraint::conclude(
    const Members& members, std::span<const Site> /*changed*/, Conclusions& conclusions
) {
    const std::size_t decided = members.count(Membership::kYes);
    const std::size_t open = members.count(Membership::kMaybe);
    if (decided > max_ || decided + open < min_) {
        return false;
    }
    const bool is_full = decided == max_;
    const bool are_all_needed = decided + open == min_;
    if (open > 0 && (is_full || are_all_needed)) {
        for (const Site site : inside_) {
            if (members.at(site) == Membership::kMaybe) {
                (is_full ? conclusions.never : conclusions.always).push_back(site);
            }
        }
    }
    return true;
}

}  // namespace modelsynth
