#pragma once

#include "solver/core/label_set.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// Tiles of at most so many columns along x and z are tried.
inline constexpr std::int32_t kTileMax = 8;

// A small model that closes on itself along x and z, repeated over the whole; the smallest that is
// found. It fits what most cells of each floor may be; some may forbid what it has there.
// Deterministic in (problem, seed). Nothing when none was found.
[[nodiscard]] std::optional<std::vector<Label>> find_any_tile(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
);

}  // namespace modelsynth::discrete
