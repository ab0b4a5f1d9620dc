#pragma once

#include "solver/core/label_set.h"

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
// Shape: one row of words() words per (label, relation); the rows of one label lie together, so
//        that one pass over the labels of a site serves all its arcs. Labels stand in groups of
//        four, and the union of the rows of every subset of a group is kept too: a set is then
//        looked up by nibbles, at most a quarter of the steps.
// Cost:  4 * labels * relations * words() words of memory.
// Thread-safe once filled.
class Relations {
  public:
    static constexpr std::size_t kGroupLabels = 4;

    // reverse[r] is the relation of the same arc seen from its far end.
    // Requires: reverse[reverse[r]] == r (checked).
    Relations(std::size_t label_count, std::vector<RelationId> reverse);

    // Allows the pair (a, b) along r, and (b, a) along its reverse.
    void allow(RelationId relation, Label a, Label b);

    [[nodiscard]] bool allows(RelationId relation, Label a, Label b) const;

    // The labels that may stand at the far end when `label` stands at the near one.
    [[nodiscard]] std::span<const Word> row(RelationId relation, Label label) const {
        return {row_data(label) + relation * words_, words_};
    }

    // The rows of all relations of one label: count() * words() words.
    [[nodiscard]] const Word* row_data(Label label) const {
        return union_data(
            label / kGroupLabels, std::size_t{1} << (label % kGroupLabels), reverse_.size() * words_
        );
    }

    // The union of those rows over the labels of a group that `members` has a bit for: label
    // kGroupLabels * group + i at bit i. `width` is count() * words(), which inner loops know.
    [[nodiscard]] const Word* union_data(std::size_t group, std::size_t members, std::size_t width)
        const {
        return unions_.data() + (group << kGroupLabels | members) * width;
    }

    [[nodiscard]] std::size_t label_count() const { return label_count_; }

    [[nodiscard]] std::size_t words() const { return words_; }

    [[nodiscard]] std::size_t count() const { return reverse_.size(); }

    [[nodiscard]] RelationId reverse(RelationId relation) const { return reverse_[relation]; }

  private:
    std::size_t label_count_;
    std::size_t words_;
    std::vector<RelationId> reverse_;
    std::vector<Word> unions_;
};

}  // namespace modelsynth
