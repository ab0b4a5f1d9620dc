#pragma once

#include "solver/core/result.h"
#include "solver/core/sat/sat_search.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

struct WholeBySat {
    SatResult result;
    std::vector<Label> labels;  // by cell, when it is solved
};

// The whole at once by CaDiCaL, for when every attempt of the search failed. The member rules are
// not asked: what is impossible is so with them, but a model need not keep to them.
// Deterministic in (problem, seed). Thread-safe.
[[nodiscard]] WholeBySat solve_whole_by_sat(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
);

// The last word on a whole that the search did not find: its labels, which need not keep to the
// member rules, or nothing when it stays unknown whether there are any.
// Fails: kContradiction when it is proved that there are none, kCancelled.
[[nodiscard]] Result<std::optional<std::vector<Label>>> settle_by_sat(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
);

}  // namespace modelsynth::discrete
