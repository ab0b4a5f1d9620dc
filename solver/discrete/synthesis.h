#pragma once

#include "solver/core/observer.h"
#include "solver/core/result.h"
#include "solver/core/synthesis_stats.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/preparation.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

struct Synthesis {
    GridSize size;
    std::vector<Label> labels;  // as Example::cells
    SynthesisStats stats;
};

// A model of the size asked for in which any two neighbours are neighbours in the example
// (Eq. 3.3): Algorithm 3.4, or Algorithm 3.1 where `parameters.blocks` asks for the whole at once.
// With `from`, a checkpoint of a run with equal arguments, in blocks: goes on after its blocks;
// the result is that of a run without.
// With several threads, blocks that do not touch are modified at the same time; the observer is
// called on this one alone, in order, and nothing it sees is different.
// Where the best of several models is asked for, all are made first, unseen, and the best once
// more.
//
// Ensures:  equal arguments give equal labels and equal reports, on any machine.
// Fails:    kContradiction, kGaveUp, kTooLarge, kCancelled when `stop` is requested: within one
//           block and within one propagation.
// Cost:     O(cells) blocks of constant size; memory: 4 bytes a cell and one block's catalog.
[[nodiscard]] Result<Synthesis> synthesise(
    Preparation& preparation,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from = nullptr,
    std::uint32_t threads = 1
);

// The same with a preparation of its own; see Preparation::make() for what it requires.
[[nodiscard]] Result<Synthesis> synthesise(
    const Example& example,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from = nullptr,
    std::uint32_t threads = 1
);

}  // namespace modelsynth::discrete
