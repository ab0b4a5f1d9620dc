#pragma once

#include "solver/continuous/problem.h"
#include "solver/core/observer.h"
#include "solver/core/result.h"
#include "solver/core/synthesis_stats.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

struct Synthesis {
    std::vector<Label> labels;  // by vertex of the problem's arrangement
    SynthesisStats stats;
};

// A model in which everything around every vertex, edge and face stands so in the example
// (Algorithm 4.1), made in blocks (4.5.6) or, with `blocks` a value without blocks, at once.
// Reports as of the discrete solver, regions in cells of one spacing.
// With several threads, blocks that do not touch are modified at the same time, unless something
// has to hang together or be symmetric; the observer is called on this thread, as with one.
// Ensures: equal arguments give equal labels and reports, on any number of threads.
// Fails:   kGaveUp for the whole at once, kCancelled.
[[nodiscard]] Result<Synthesis> synthesise(
    const Problem& problem,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from = nullptr,
    std::uint32_t threads = 1
);

}  // namespace modelsynth::continuous
