#include "solver/core/relations.h"

#include "solver/core/result.h"

#include <bit>
#include <utility>

namespace modelsynth {

Relations::Relations(std::size_t label_count, std::vector<RelationId> reverse)
    : label_count_(label_count),
      words_(words_for(label_count)),
      group_bits_(group_bits_for(words_, reverse.size())),
      reverse_(std::move(reverse)),
      stride_(stride_for(reverse_.size(), words_)) {
    check(label_count <= kLabelCountMax, "more labels than a label number can hold");
    const std::size_t groups = words_ * kWordBits / group_bits_;
    unions_ = AlignedWords((groups << group_bits_) * stride_);
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
        Word* const rows = unions_.data();
        const std::size_t group = from / group_bits_;
        const std::size_t member = std::size_t{1} << (from % group_bits_);
        const std::size_t word = r * words_ + to / kWordBits;
        for (std::size_t members = member; members < std::size_t{1} << group_bits_;
             members = (members + 1) | member) {
            rows[(group << group_bits_ | members) * stride_ + word] |= Word{1} << (to % kWordBits);
        }
    };
    set(relation, a, b);
    set(reverse_[relation], b, a);
}

bool Relations::allows(RelationId relation, Label a, Label b) const {
    return ((row(relation, a)[b / kWordBits] >> (b % kWordBits)) & 1) != 0;
}

void add_up_unions(
    Word* table, std::size_t label_count, std::size_t group_bits, std::size_t stride
) {
    const std::size_t members_end = std::size_t{1} << group_bits;
    for (std::size_t first = 0; first < label_count; first += group_bits) {
        Word* const unions = table + (first / group_bits << group_bits) * stride;
        for (std::size_t members = 1; members < members_end; ++members) {
            // What the last of them allows, and the others.
            const std::size_t last = std::bit_floor(members);
            for (std::size_t word = 0; last != members && word < stride; ++word) {
                unions[members * stride + word] =
                    unions[last * stride + word] | unions[(members ^ last) * stride + word];
            }
        }
    }
}

}  // namespace modelsynth
