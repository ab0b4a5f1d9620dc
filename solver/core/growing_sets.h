#pragma once

#include "solver/core/label_set.h"
#include "solver/core/label_weights.h"
#include "solver/core/random.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {

// Sets of labels of which no object begins by itself: it goes on from where it was begun. They are
// kept for every kind of site, as the labels are numbered there.
// Requires: what it refers to outlives it. Thread-safe.
class GrowingSets {
  public:
    // Shape: `sets` has, by kind and then by set, so many words; kinds are those of the sites of a
    // part, and null where all are of kind 0.
    GrowingSets(
        std::vector<Word> sets, std::size_t count, std::size_t words, const std::uint8_t* kinds
    )
        : sets_(std::move(sets)), count_(count), words_(words), kinds_(kinds) {}

    // Whether the site has several labels left, all of one of the sets.
    [[nodiscard]] bool is_bound(Site site, std::span<const Word> labels) const {
        if (!has_several(labels)) {
            return false;
        }
        for (std::size_t i = 0; i < count_; ++i) {
            const Word* const own = set(site, i);
            Word without = 0;
            for (std::size_t word = 0; word < words_; ++word) {
                without |= labels[word] & ~own[word];
            }
            if (without == 0) {
                return true;
            }
        }
        return false;
    }

    // A label drawn by weight, of none of the sets as far as there is a choice.
    [[nodiscard]] Label draw(
        Site site, std::span<const Word> labels, const LabelWeights& weights, RandomStream& random
    ) const {
        std::vector<Word> left(labels.begin(), labels.end());
        std::vector<Word> without(words_);
        for (std::size_t i = 0; i < count_; ++i) {
            const Word* const own = set(site, i);
            for (std::size_t word = 0; word < words_; ++word) {
                without[word] = left[word] & ~own[word];
            }
            if (!is_empty(without)) {
                left = without;
            }
        }
        return weights.draw(left, random);
    }

  private:
    [[nodiscard]] const Word* set(Site site, std::size_t number) const {
        const std::size_t kind = kinds_ == nullptr ? 0 : kinds_[site];
        return sets_.data() + (kind * count_ + number) * words_;
    }

    std::vector<Word> sets_;
    std::size_t count_;
    std::size_t words_;
    const std::uint8_t* kinds_;
};

}  // namespace modelsynth
