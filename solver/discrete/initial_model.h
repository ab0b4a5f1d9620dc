#pragma once

#include "solver/core/block_search.h"
#include "solver/core/result.h"
#include "solver/discrete/box_search.h"
#include "solver/discrete/example.h"
#include "solver/discrete/preparation.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// A model that is consistent before any block is modified (Algorithm 3.4, lines 3-5).
struct InitialModel {
    std::shared_ptr<const std::vector<Label>> labels;  // the preparation's own where they will do
    bool is_searched = false;  // as varied as any; else plain: the blocks are to make it so
};

// Tried in turn:
//   1. one piece per floor that stands next to itself, such as ground below and nothing above;
//   2. the whole at once, by search, a few times, unless it is large;
//   3. a small tile that repeats along x and z;
//   4. the whole at once, many times.
// A model to start from is put over the first one. Where cells are wrong then, because something is
// fixed there or along its seam, they are mended by making a growing box around them anew. Where a
// count asks for more pieces, they are planted; what other constraints ask beyond that only a
// search of the whole can give. `search` is one of the preparation's. Deterministic in
// (preparation, seed). Fails: kContradiction when propagation proves that nothing fits, kGaveUp
// when nothing was found, kCancelled; the message names pieces and sides, or the constraint.
[[nodiscard]] Result<InitialModel> find_initial_model(
    const Preparation& preparation,
    BoxSearch& search,
    std::uint64_t seed,
    const std::stop_token& stop
);

// The first way alone, with nothing to mend: then it depends on no seed. Nothing when there is
// none.
[[nodiscard]] std::optional<std::vector<Label>> find_plain_model(
    const Example& example, const Problem& problem
);

// The error for a search of the whole that was proved impossible.
[[nodiscard]] Error contradiction_of(
    const Example& example, const Problem& problem, const BlockResult& result
);

}  // namespace modelsynth::discrete
