#include "solver/core/relations.h"

#include "solver/core/result.h"

#include <utility>

namespace modelsynth {

Relations::Relations(std::size_t label_count, std::vector<RelationId> reverse)
    : label_count_(label_count),
      words_(words_for(label_count)),
      reverse_(std::move(reverse)),
      unions_(
          ((label_count + kGroupLabels - 1) / kGroupLabels << kGroupLabels) * reverse_.size() *
          words_
      ) {
    check(label_count <= kLabelCountMax, "more labels than a label number can hold");
    for (std::size_t relation = 0; relation < reverse_.size(); ++relation) {
        check(
            reverse_[relation] < reverse_.size() && reverse_[reverse_[relation]] == relation,
            "the reverse of a relation's reverse is not the relation"
        );
    }
}

void Relations::allow(RelationId relation, Label a, Label b) {
    check(a < label_count_ && b < label_count_, "a label outside the relation");
    if (allows(relation, a, b)) {
        return;
    }
    const auto set = [this](RelationId r, Label from, Label to) {
        const std::size_t group = from / kGroupLabels;
        const std::size_t member = std::size_t{1} << (from % kGroupLabels);
        for (std::size_t members = 0; members < (1U << kGroupLabels); ++members) {
            if ((members & member) != 0) {
                const std::size_t row = (group << kGroupLabels | members) * reverse_.size() + r;
                unions_[row * words_ + to / kWordBits] |= Word{1} << (to % kWordBits);
            }
        }
    };
    set(relation, a, b);
    set(reverse_[relation], b, a);
}

bool Relations::allows(RelationId relation, Label a, Label b) const {
    return ((row(relation, a)[b / kWordBits] >> (b % kWordBits)) & 1) != 0;
}

}  // namespace modelsynth
