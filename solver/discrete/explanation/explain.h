#pragma once

#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/problem.h"

#include <stop_token>

namespace modelsynth::discrete {

// The error for a request that was proved impossible, with the fewest causes found that cannot hold
// together and the fewest cells found at which it shows: a Contradiction as its explanation, and in
// words for a person. `error` is what is known already; it comes back as it is when no proof is
// found again, as of a contradiction that only the search with some seed came upon.
// Requires: find_faults() found nothing (checked); the problem is that of the request, of
//           read_problem() or make_problem().
// Fails:    kCancelled instead when `stop` is requested.
// Cost:     bounded by counted steps, a few seconds at most; a small fraction of one as a rule.
// Deterministic. Thread-safe.
[[nodiscard]] Error explain(
    Error error,
    const Example& example,
    const Parameters& parameters,
    const Problem& problem,
    const std::stop_token& stop
);

}  // namespace modelsynth::discrete
