#pragma once

#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/symmetry/symmetries.h"
#include "solver/core/result.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"

#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

// With a ground, a model's box begins so many spacings below it: what stands on it has its lowest
// planes inside.
inline constexpr double kBelowGround = 0.25;

// Empty space, or the bare ground.
[[nodiscard]] std::vector<Label> plain_labels(
    const ExampleReading& reading, const Arrangement& arrangement
);

// A model to begin with that keeps to the domains: the plain labels, and where they do not fit,
// what fits and is as plain as can be found. Symmetries may be null.
// Fails: kContradiction with the place when it is proved that nothing fits, kGaveUp,
// kCancelled when `stop` is requested.
[[nodiscard]] Result<std::vector<Label>> find_initial_labels(
    const Relations& relations,
    const Arrangement& arrangement,
    const Symmetries* symmetries,
    const SiteDomains& domains,
    const SiteWeights& weights,
    std::vector<Label> plain,
    const std::stop_token& stop = {}
);

}  // namespace modelsynth::continuous
