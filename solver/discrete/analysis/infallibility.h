#pragma once

#include "solver/core/grid.h"
#include "solver/core/result.h"
#include "solver/discrete/analysis/counterexample.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/example.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

namespace modelsynth::discrete {

enum class Infallibility : std::uint8_t { kInfallible, kFallible, kUnknown };

// What a verdict of infallibility rests on.
enum class InfallibilityProof : std::uint8_t {
    kNone,         // it is no such verdict
    kOneAxis,      // along one axis arc consistency is exact (thesis 3.3.5, last remark)
    kEquation311,  // every corner can be closed; see check_corners()
    kRegion,       // the induction over regions; see prove_by_region()
};

// Whether Algorithm 3.1 can fail for an example (thesis 3.3.7).
//
// The verdict is about models of every size with at least two cells along each axis along which
// the example has neighbours (one cell along the others), with all sides free, labelled whole in
// the order of column_order(), and never taking anything back:
//   kInfallible: proved; every label that the catalog offers for the next cell leads to a complete
//                model. Where there is no model of a size, the catalog is empty at the start.
//   kFallible:   proved by `counterexample`, a state that such a run came to.
//   kUnknown:    neither; larger regions, larger boxes or more work may tell.
// It says nothing of fixed sides and cells, of other orders, or of blocks in a model that
// stands, all of which put labels ahead of the cells to be labelled; success_curve.h measures
// these.
struct InfallibilityVerdict {
    Infallibility kind = Infallibility::kUnknown;
    InfallibilityProof proof = InfallibilityProof::kNone;
    std::optional<GridSize> region;                // for kRegion: cells of the region
    std::optional<Counterexample> counterexample;  // for kFallible
    // From this size on in every direction there is no model at all, where arc consistency proves
    // it: a size of up to 16 cells along each axis. Then "infallible" says only that such models
    // are never begun.
    std::optional<GridSize> impossible_from;
    std::uint64_t steps = 0;  // of work
    std::string description;  // a sentence or two for a person
};

struct InfallibilityOptions {
    std::uint64_t steps_max = 1'000'000;  // of work; a microsecond to some ten of them each
    CounterexampleSearch search;
};

// Tries, in turn: Eq. 3.11; runs in small boxes, with at most half of the work; the induction for
// regions of up to 12 cells, each with at most a quarter of it.
// Ensures: deterministic in its arguments.
// Fails:   kCancelled when `stop` is requested.
// Cost:    steps_max steps at most; memory within some 100 bytes a step. Thread-safe.
[[nodiscard]] Result<InfallibilityVerdict> judge_infallibility(
    const Transitions& transitions, const InfallibilityOptions& options, const std::stop_token& stop
);

// Whether it is proved, with little work, that models of an example are made whole in one pass
// without a dead end: by the example's own boundary, which must leave all sides free, by Eq. 3.11
// or by a small region.
//
// What true covers: the sizes of InfallibilityVerdict, with all sides free, nothing fixed and no
// constraints, and with no label removed by a weight of 0 that the example does not remove; the
// whole at once, its cells labelled in the order of column_order(). Nothing else is covered:
// periodic sides, sides with pieces of their own, blocks and other orders may come to a dead end.
// False says nothing.
// Cost: reading the transitions, and steps_max steps at most: a few milliseconds for a hundred
//       labels. Thread-safe.
[[nodiscard]] bool is_proved_infallible(const Example& example, std::uint64_t steps_max = 20'000);

// What the core of a counterexample is, with the names of the example's pieces: one sentence.
[[nodiscard]] std::string describe(const Counterexample& counterexample, const Example& example);

}  // namespace modelsynth::discrete
