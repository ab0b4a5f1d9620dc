#pragma once

#include "solver/discrete/analysis/split_labels.h"
#include "solver/discrete/analysis/work.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace modelsynth::discrete {

// What a split was proved to be infallible by, see infallibility.h.
enum class SplitProof : std::uint8_t { kEquation311, kSmallestRegion };

// Labels without ends, proved to be infallible.
struct ProvedLabels {
    SplitLabels labels;
    SplitProof proof = SplitProof::kEquation311;
};

// Merges labels that stand for the same one back, one pair after the other, as long as what is left
// when ends are removed is infallible and stands for no fewer labels. Merged labels have all
// the models they had apart, so nothing is lost by it.
//
// Returns nothing where the labels, their ends removed, are not proved infallible to begin with.
// Ensures:  no two labels can be merged further, if the work was enough; deterministic.
// Cost:     O(pairs) proofs for each merge; ends when the work is used up. `region_steps` of it
//           at most for each proof by region, where Eq. 3.11 does not hold.
[[nodiscard]] std::optional<ProvedLabels> merge_labels(
    SplitLabels labels, std::size_t original_count, std::uint64_t region_steps, Work& work
);

}  // namespace modelsynth::discrete
