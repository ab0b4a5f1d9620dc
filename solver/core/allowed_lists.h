#pragma once

#include "solver/core/relations.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// Relations as lists, for those that allow a label few others: what went can be followed pair by
// pair then, for less than it takes to add up the rows of all that is left.
// Cost: two bytes a pair. Thread-safe.
class AllowedLists {
  public:
    // Pairs of a label in all relations, on average, beyond which nobody wants the lists.
    static constexpr std::size_t kPairsMax = 512;

    explicit AllowedLists(const Relations& relations);

    // Whether there are more pairs than that: then all lists are empty.
    [[nodiscard]] bool is_dense() const { return is_dense_; }

    // Of a label in all relations, on average, rounded up.
    [[nodiscard]] std::size_t pairs_per_label() const { return pairs_per_label_; }

    // The labels of relations.row(relation, label), in rising order.
    [[nodiscard]] std::span<const Label> allowed(RelationId relation, Label label) const {
        const std::size_t list = relation * label_count_ + label;
        return {lists_.data() + firsts_.data()[list], lists_.data() + firsts_.data()[list + 1]};
    }

  private:
    std::size_t label_count_;
    std::size_t pairs_per_label_ = 0;
    bool is_dense_ = false;
    std::vector<Label> lists_;
    std::vector<std::uint32_t> firsts_;  // where in lists_ each begins, and the end of the last
};

}  // namespace modelsynth
