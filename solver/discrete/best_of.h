#pragma once

#include "solver/core/result.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace modelsynth::discrete {

// The seed of the n-th of several models of one request: the request's own for the first.
// Cost: O(1). At most 2^53 - 1, as seeds are.
[[nodiscard]] std::uint64_t candidate_seed(std::uint64_t seed, std::uint32_t candidate);

struct BestSeed {
    std::uint64_t seed = 0;
    double value = 0;                               // of its model
    std::vector<std::optional<double>> candidates;  // nothing where none was made
};

// The seed whose model has the least sum of errors, of equal ones the first.
// `make` makes the model of a seed; it is called from several threads at once.
// Fails: as the last model when none could be made; kCancelled as soon as one was.
[[nodiscard]] Result<BestSeed> find_best_seed(
    const Example& example,
    const Parameters& parameters,
    std::uint32_t candidates,
    std::uint64_t seed,
    std::uint32_t threads,
    const std::function<Result<std::vector<Label>>(std::uint64_t)>& make
);

}  // namespace modelsynth::discrete
