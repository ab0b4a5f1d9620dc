#pragma once

#include "solver/core/label_set.h"
#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace modelsynth::discrete {

// A label that copies a part of the example wherever it stands: with it all its neighbours are
// known, and so are more.
struct ForcedPatch {
    Label label = 0;
    std::size_t cell_count = 0;  // with its own; where it forces least
    LabelSet labels;             // that stand in these cells
    bool is_whole = true;        // false: it reached a side, and a larger model may have more

    friend bool operator==(const ForcedPatch&, const ForcedPatch&) = default;
};

// What can be said of the labels of an example, one by one.
struct LabelFacts {
    std::vector<std::size_t> counts;  // cells of the example, by label
    LabelSet absent;                  // neither in a cell nor in `adjacency`: never used
    LabelSet once;                    // in one cell, and not in `adjacency`
    LabelSet unreachable;  // may be used, but nowhere in a model of the size and boundary given
    // Next to itself along x, y, z; and along every axis that any labels are neighbours along.
    std::array<LabelSet, 3> self_adjacent;
    LabelSet repeating;
    std::vector<ForcedPatch> forced;  // by label
    bool are_forced_complete = true;  // false: the work was used up before every label was placed
    // One piece a floor, see find_plain_model(): a consistent model to begin with (Algorithm 3.4,
    // lines 3-5) without a search.
    bool has_plain_model = false;
    // Why no model of the size and boundary exists, where arc consistency proves it; then
    // `unreachable` and `forced` are empty.
    std::optional<std::string> contradiction;
};

// Looks at the catalog that the boundary leaves in a model of the size given, before any choice
// (thesis 3.3.2): a label that is not in it stands nowhere; one that is may still not be.
// For `forced` each label is placed in the middle of a model of up to 21 cells along x and z with
// this boundary, at every height at which it can stand: at most placements_max times.
// Requires: defaults filled in and find_faults() empty (checked).
// Fails:    kCancelled when `stop` is requested.
// Cost:     one propagation over the model, and labels * height or placements_max over 21 x height
// x
//           21 cells.
//           Thread-safe.
[[nodiscard]] Result<LabelFacts> find_label_facts(
    const Example& example,
    const Parameters& parameters,
    const std::stop_token& stop,
    std::uint64_t placements_max = 20'000
);

}  // namespace modelsynth::discrete
