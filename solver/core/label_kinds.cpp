#include "solver/core/label_kinds.h"

#include "solver/core/result.h"

#include <algorithm>
#include <array>
#include <utility>

namespace modelsynth {

LabelKinds::LabelKinds(std::span<const LabelSet> sets) : of_kind_(sets.size()) {
    check(sets.size() <= kCountMax, "more kinds than are told apart");
    for (std::size_t kind = 0; kind < sets.size(); ++kind) {
        Kind& own = of_kind_[kind];
        own.set = sets[kind];
        own.numbers.assign(sets[kind].label_count(), kNoLabel);
        for_each_label(sets[kind].words(), [&own](Label label) {
            own.numbers[label] = static_cast<Label>(own.labels.size());
            own.labels.push_back(label);
        });
        words_ = std::max(words_, words_for(own.labels.size()));
    }
}

void LabelKinds::put_numbered(std::uint8_t kind, std::span<const Word> labels, Word* numbered)
    const {
    const Kind& own = of_kind_[kind];
    std::fill_n(numbered, words_, Word{0});
    for (std::size_t word = 0; word < labels.size(); ++word) {
        const std::array<Word, 1> there = {labels[word] & own.set.words()[word]};
        for_each_label(there, [&](Label label) {
            const Label number = own.numbers[word * kWordBits + label];
            numbered[number / kWordBits] |= Word{1} << (number % kWordBits);
        });
    }
}

SiteWeights LabelKinds::numbered(const SiteWeights& weights) const {
    std::vector<LabelWeights> tables;
    for (std::size_t table = 0; table < weights.table_count(); ++table) {
        for (const Kind& kind : of_kind_) {
            tables.push_back(weights.table(table).of_labels(kind.labels));
            if (weights.is_same_everywhere()) {
                tables.back().add_up_groups();
            }
        }
    }
    return {std::move(tables), {}};
}

}  // namespace modelsynth
