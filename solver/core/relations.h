#pragma once

#include "solver/core/aligned_words.h"
#include "solver/core/label_set.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

using RelationId = std::uint16_t;

// Which pairs of labels may stand at the two ends of an arc, for every kind of arc.
//
// A relation r is a binary matrix over the labels: allows(r, a, b) says that b may stand at the
// far end of an arc of kind r whose near end has a (the transition matrices T of the thesis,
// Eq. 3.2). Every relation has a reverse, the transposed matrix, for the same arc seen from its
// other end; a relation may be its own reverse.
//
// Shape: a row holds words() words for each relation, and is filled up to stride() words, so that
//        one pass over the labels of a site serves all its arcs, some words at a time. Labels
//        stand in groups of group_bits(), and the union of the rows of every subset of a group is
//        kept: a set is looked up group by group.
// Cost:  2^group_bits() / group_bits() * labels * stride() words of memory: 130 KB for 64 labels
//        of a grid, 390 KB for 128, 590 KB for 256, 9 MB for 1 000.
// Thread-safe once filled.
class Relations {
  public:
    // Groups are bytes as long as their table fits the caches of a core, nibbles beyond.
    static constexpr std::size_t group_bits_for(std::size_t words, std::size_t relation_count) {
        return words <= 2 && relation_count <= 8 ? 8 : 4;
    }

    static constexpr std::size_t stride_for(std::size_t relation_count, std::size_t words) {
        return (relation_count * words + kVectorWords - 1) / kVectorWords * kVectorWords;
    }

    // reverse[r] is the relation of the same arc seen from its far end.
    // Requires: reverse[reverse[r]] == r (checked).
    Relations(std::size_t label_count, std::vector<RelationId> reverse);

    // Allows the pair (a, b) along r, and (b, a) along its reverse.
    void allow(RelationId relation, Label a, Label b);

    [[nodiscard]] bool allows(RelationId relation, Label a, Label b) const;

    // The labels that may stand at the far end when `label` stands at the near one.
    [[nodiscard]] std::span<const Word> row(RelationId relation, Label label) const {
        const std::size_t member = std::size_t{1} << (label & (group_bits_ - 1));
        // The group by a shift: a division by what the compiler does not know takes long.
        const auto shift = static_cast<unsigned>(std::countr_zero(group_bits_));
        return {union_data(std::size_t{label} >> shift, member) + relation * words_, words_};
    }

    // The union of the rows over the labels of a group that `members` has a bit for: label
    // group_bits() * group + i at bit i. The rows of all unions lie one after the other, those of
    // a group by rising `members`, the first one at a multiple of 64 bytes.
    [[nodiscard]] const Word* union_data(std::size_t group, std::size_t members) const {
        return unions_.data() + (group << group_bits_ | members) * stride_;
    }

    [[nodiscard]] std::size_t label_count() const { return label_count_; }

    [[nodiscard]] std::size_t words() const { return words_; }

    [[nodiscard]] std::size_t stride() const { return stride_; }

    [[nodiscard]] std::size_t group_bits() const { return group_bits_; }

    [[nodiscard]] std::size_t count() const { return reverse_.size(); }

    [[nodiscard]] RelationId reverse(RelationId relation) const { return reverse_[relation]; }

  private:
    static constexpr std::size_t kVectorWords = 4;

    std::size_t label_count_;
    std::size_t words_;
    std::size_t group_bits_;
    std::vector<RelationId> reverse_;
    std::size_t stride_;
    AlignedWords unions_;
};

// Fills the rows of all unions of labels, where those of one label each are there: a table as of
// Relations::union_data().
void add_up_unions(
    Word* table, std::size_t label_count, std::size_t group_bits, std::size_t stride
);

}  // namespace modelsynth
