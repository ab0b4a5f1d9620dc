#pragma once

#include "solver/core/constraints/set_constraint.h"

#include <cstddef>

namespace modelsynth {

// At least `min` and at most `max` sites belong to the set.
// Cost: O(1) a call, O(sites inside) when it has something to say.
class CountConstraint final : public SetConstraint {
  public:
    CountConstraint(std::size_t min, std::size_t max) : min_(min), max_(max) {}

    void enter(const Members& members, std::span<const Site> inside) override;
    [[nodiscard]] bool conclude(
        const Members& members, std::span<const Site> changed, Conclusions& conclusions
    ) override;

  private:
    std::size_t min_;
    std::size_t max_;
    std::vector<Site> inside_;
};

}  // namespace modelsynth
