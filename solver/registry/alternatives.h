#pragma once

#include "solver/core/result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth {

// Candidates in a row that bring no new model, after which no more are made.
inline constexpr std::uint32_t kFruitlessCandidatesMax = 8;

// Several different models of one request: which seeds to try and when to stop. Candidates are
// made one after another, each from a seed of its own, the first from the request's; one that is
// equal to an earlier model, or that the search gave up, is replaced by another. A request has
// fewer models than wanted when so many candidates in a row brought nothing new.
// Not thread-safe.
class Alternatives {
  public:
    Alternatives(std::uint64_t seed, std::uint32_t wanted) : seed_(seed), wanted_(wanted) {}

    [[nodiscard]] std::uint32_t wanted() const { return wanted_; }

    // New models so far.
    [[nodiscard]] std::uint32_t made() const { return static_cast<std::uint32_t>(models_.size()); }

    // Candidates so far, whatever became of them.
    [[nodiscard]] std::uint32_t candidates() const { return candidates_; }

    // No candidate is to be made any more.
    [[nodiscard]] bool is_complete() const;

    // The seed of the next candidate, at most 2^53 - 1. O(1).
    [[nodiscard]] std::uint64_t next_seed() const;

    // The candidate is the model that the text stands for, such as a digest of it. The earlier
    // model that it is equal to, counted from 0; nothing when it is new. O(made()).
    [[nodiscard]] std::optional<std::uint32_t> add(std::string model);

    // The candidate became no model. Whether another may: a proof that there is no model holds
    // for every seed.
    [[nodiscard]] bool add_failure(ErrorCode code);

  private:
    std::uint64_t seed_;
    std::uint32_t wanted_;
    std::uint32_t candidates_ = 0;
    std::uint32_t fruitless_ = 0;
    std::vector<std::string> models_;
};

}  // namespace modelsynth
