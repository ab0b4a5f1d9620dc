#pragma once

#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// A model that is consistent before any block is modified (Algorithm 3.4, lines 3-5), as plain as
// can be found. Tried in turn:
//   1. one piece per floor that stands next to itself, such as ground below and nothing above;
//   2. a small tile that repeats along x and z;
//   3. the whole at once, by search.
// Cells that the first two leave wrong, because something is fixed there, are mended by making a
// growing box around them anew.
// Deterministic in (problem, seed). Fails: kContradiction when propagation proves that nothing
// fits, kGaveUp when nothing was found, kCancelled; the message names pieces and sides.
[[nodiscard]] Result<std::vector<Label>> find_initial_model(
    const Example& example, const Problem& problem, std::uint64_t seed, const std::stop_token& stop
);

// That model when it depends on no seed: the first way, with nothing to mend. Nothing when there is
// none.
[[nodiscard]] std::optional<std::vector<Label>> find_plain_model(
    const Example& example, const Problem& problem
);

// The sites of a grid column by column, each from the bottom up: the order of Algorithm 3.1.
[[nodiscard]] std::vector<Site> column_order(const GridSize& size);

// The error for a cell that propagation left without any piece.
[[nodiscard]] Error contradiction_at(
    const Example& example, const Problem& problem, const Cell& cell
);

}  // namespace modelsynth::discrete
