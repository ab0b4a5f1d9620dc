#pragma once

#include "solver/continuous/parameters.h"
#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/planes/model_planes.h"
#include "solver/continuous/reading/reading.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"

#include <span>

namespace modelsynth::continuous {

// The figures each vertex may take by itself: those that change only across its planes, that look
// the same as `plain` along edges that leave the box where it is closed, and that weights,
// dimensions and regions leave. Cost: O(kinds of vertices * figures), and that of
// narrow_to_regions().
[[nodiscard]] SiteDomains make_domains(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Arrangement& arrangement,
    const ModelPlanes& planes,
    std::span<const Label> plain
);

// How often each figure should be chosen: density, the weights of the objects in it, and what
// probabilities make of them at the vertex.
// Fails: kTooLarge for too many different tables.
[[nodiscard]] Result<SiteWeights> make_weights(
    const ExampleReading& reading, const Parameters& parameters, const Arrangement& arrangement
);

}  // namespace modelsynth::continuous
