#pragma once

#include "solver/core/label_set.h"
#include "solver/core/site_weights.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// Labels numbered anew for each kind of site, from 0 and in their order: those that can stand at
// sites of the kind. Sets get shorter, and what is drawn from them stays the same.
// Cost: two bytes for each kind and label of the whole. Thread-safe.
class LabelKinds {
  public:
    // More are not told apart.
    static constexpr std::size_t kCountMax = 64;

    LabelKinds() = default;

    // Shape: one set for each kind.
    explicit LabelKinds(std::span<const LabelSet> sets);

    [[nodiscard]] std::size_t count() const { return of_kind_.size(); }

    // Of the set of any kind.
    [[nodiscard]] std::size_t words() const { return words_; }

    // Of a kind, in rising order: label i is numbered i there.
    [[nodiscard]] std::span<const Label> labels(std::uint8_t kind) const {
        return of_kind_[kind].labels;
    }

    // kNoLabel where the label cannot stand at sites of the kind.
    [[nodiscard]] Label number(std::uint8_t kind, Label label) const {
        return of_kind_[kind].numbers[label];
    }

    // A set of the whole, numbered anew; what cannot stand there is left out.
    // Shape: `numbered` has words().
    void put_numbered(std::uint8_t kind, std::span<const Word> labels, Word* numbered) const;

    // Of a site that has table t and is of kind k, the table is t * count() + k.
    [[nodiscard]] SiteWeights numbered(const SiteWeights& weights) const;

  private:
    struct Kind {
        LabelSet set;
        std::vector<Label> labels;
        std::vector<Label> numbers;  // by label of the whole
    };

    std::vector<Kind> of_kind_;
    std::size_t words_ = 0;
};

}  // namespace modelsynth
