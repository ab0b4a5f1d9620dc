#pragma once

#include "solver/core/label_set.h"
#include "solver/core/random.h"

#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// How often each label should be chosen, against the others possible at the site.
//
// Integers, so that sums and choices are the same on every machine; weights given as numbers are
// scaled so that the largest becomes 2^20. Thread-safe.
class LabelWeights {
  public:
    static constexpr std::uint32_t kLargest = 1U << 20;

    // Requires: every weight finite and >= 0 (checked). A positive weight stays positive.
    explicit LabelWeights(std::span<const double> weights);

    // The weights of some of the labels, numbered anew in the order given: sets of them are drawn
    // from as if they were numbered as before.
    [[nodiscard]] LabelWeights of_labels(std::span<const Label> labels) const;

    [[nodiscard]] std::uint32_t of(Label label) const { return weights_[label]; }

    // A label of the set, drawn by weight; all alike when every weight in the set is 0.
    // Requires: the set is not empty (checked).
    [[nodiscard]] Label draw(std::span<const Word> set, RandomStream& random) const;

    // Shannon entropy of the draw in units of 2^-16 bits, by integer arithmetic.
    [[nodiscard]] std::uint32_t entropy(std::span<const Word> set) const;

    // Makes entropy() several times faster, for 64 bytes a label; it returns the same.
    void add_up_groups();

  private:
    static constexpr std::size_t kGroupBits = 4;

    LabelWeights() = default;

    // Fills entropy_of_count_.
    void find_equal();

    // Over the labels of a set.
    struct Sums {
        std::uint64_t weights = 0;
        std::uint64_t logs = 0;  // of weighted_logs_
    };

    [[nodiscard]] Sums add_up(std::span<const Word> set) const;

    std::vector<std::uint32_t> weights_;
    std::vector<std::uint64_t> weighted_logs_;  // w * log2(w), in units of 2^-16
    // Of every subset of the labels kGroupBits * i ..., label kGroupBits * i + j at bit j of its
    // number; subsets of one group lie side by side. Empty before add_up_groups().
    std::vector<Sums> group_sums_;
    // By the number of labels, where all have the same weight; empty where they have not.
    std::vector<std::uint32_t> entropy_of_count_;
};

// log2(value) in units of 2^-16, exact to a few units. Requires: value > 0.
[[nodiscard]] std::uint32_t fixed_log2(std::uint64_t value);

}  // namespace modelsynth
