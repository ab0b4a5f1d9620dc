#pragma once

#include "solver/core/label_set.h"
#include "solver/core/result.h"
#include "solver/discrete/analysis/label_merging.h"
#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/example.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

enum class SplitMethod : std::uint8_t {
    kRules,  // split_by_rules(): all models are kept that can go on beyond their far sides
    kCells,  // split_by_cells(): models may be lost
};

// An infallible set of labels, of which some stand for the same label of a fallible example (thesis
// 3.3.8).
//
// Sound (Eq. 3.13, from right to left): if M is a model of the new labels, then f(M) is one of
// the example. Proof: let a and b be neighbours in M along an axis. They were made neighbours
// only where f(a) and f(b) are so in the example: a copy has the neighbours of what it is a copy
// of; merging labels of one f unites theirs; labels of cells are neighbours where their cells
// are; all else removes pairs. So every pair in f(M) is allowed.
// Infallible: see infallibility.h for the sizes, sides and orders that this is said of.
// Complete (from left to right): see `method`, and how much is kept of small models can only be
// counted.
struct Splitting {
    Transitions transitions;       // of the new labels
    std::vector<Label> originals;  // by new label, what it stands for: f
    SplitProof proof = SplitProof::kEquation311;
    SplitMethod method = SplitMethod::kRules;
    // Labels of the example that none stands for. By rules: those that stand only near a far side
    // in any model, so that those after them come to an end.
    LabelSet lost;
};

struct SplittingOptions {
    std::uint64_t steps_max = 1'000'000;  // of work; about a microsecond each
    // New labels on the way, at most, for each label of the example (at least 1), and besides;
    // merging comes after.
    std::size_t labels_per_label = 8;
    std::size_t labels_more = 32;
    // For one proof by the smallest region, tried in merging where Eq. 3.11 does not hold.
    std::uint64_t region_steps = 2'000;
};

// Splits by rules, and by cells where that fails, along the axes in either order; merges back; the
// best is the one with the fewest labels lost, then the fewest labels. Nothing where none was
// found, where the example has no models that go on, or has neighbours along fewer than two axes.
// Many examples have none that this finds: those whose labels stand for things that any number of
// cells lie between are split without end by rules, and by cells until no label has room to repeat.
// Of an example that is infallible itself, it may be told that nothing is to be split.
// Requires: `transitions` read from the example.
// Ensures:  deterministic in its arguments.
// Fails:    kCancelled when `stop` is requested.
// Cost:     steps_max steps at most; memory O(labels^2) bits. Thread-safe.
[[nodiscard]] Result<std::optional<Splitting>> find_splitting(
    const Example& example,
    const Transitions& transitions,
    const SplittingOptions& options,
    const std::stop_token& stop
);

}  // namespace modelsynth::discrete
