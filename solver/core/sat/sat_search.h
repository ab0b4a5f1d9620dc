#pragma once

#include "solver/core/label_set.h"
#include "solver/core/random.h"
#include "solver/core/relations.h"
#include "solver/core/sat/label_formula.h"
#include "solver/core/sat/sat_limits.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>

namespace modelsynth {

enum class SatOutcome : std::uint8_t {
    kSolved,
    kImpossible,  // proved
    kGaveUp,      // the formula or the proof is too large
    kStopped,     // the stop token was requested
};

struct SatResult {
    SatOutcome outcome = SatOutcome::kGaveUp;
    std::size_t literal_count = 0;     // of the formula, as far as it was made
    std::uint64_t conflict_count = 0;  // dead ends learned from
};

// What RandomKey::purpose says of the stream drawn here.
inline constexpr std::uint32_t kPurposeSat = 3;

// Labels for all sites of a topology, or a proof that there are none: for what the search failed
// at. It sees what follows from many dead ends together, where the search takes back one choice
// after the other, but it needs room for every pair of neighbours, and what it makes is drawn less
// freely.
// Shape:    sets holds relations.words() words a site, as Catalog::all_labels(), and may be what
//           propagation left, which keeps the formula small; labels has one for each site.
// Requires: key.purpose zero; it is set here.
// Ensures:  labels is written when and only when it is kSolved. Deterministic in all arguments.
// Thread-safe.
template <Topology T>
[[nodiscard]] SatResult solve_by_sat(
    const T& topology,
    const Relations& relations,
    std::span<const Word> sets,
    const PartWeights& weights,
    RandomKey key,
    const SatLimits& limits,
    const std::stop_token& stop,
    std::span<Label> labels
) {
    key.purpose = kPurposeSat;
    RandomStream random(key);
    LabelFormula formula(relations, sets, limits.literals_max, random.next());
    formula.add_arcs(topology);
    if (formula.is_too_large()) {
        return {SatOutcome::kGaveUp, formula.literal_count(), 0};
    }
    formula.prefer_drawn(weights, random);
    const auto result = [&formula](SatOutcome outcome) {
        return SatResult{outcome, formula.literal_count(), formula.conflict_count()};
    };
    switch (formula.solve({}, limits.conflicts_max, stop)) {
        case CnfOutcome::kSatisfied:
            for (std::size_t site = 0; site < labels.size(); ++site) {
                labels[site] = formula.label(static_cast<Site>(site));
            }
            return result(SatOutcome::kSolved);
        case CnfOutcome::kUnsatisfiable:
            return result(SatOutcome::kImpossible);
        case CnfOutcome::kStopped:
            return result(SatOutcome::kStopped);
        case CnfOutcome::kGaveUp:
            break;
    }
    return result(SatOutcome::kGaveUp);
}

}  // namespace modelsynth
