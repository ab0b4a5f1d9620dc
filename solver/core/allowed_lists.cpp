#include "solver/core/allowed_lists.h"

namespace modelsynth {

AllowedLists::AllowedLists(const Relations& relations) : label_count_(relations.label_count()) {
    const std::size_t rows = relations.count() * label_count_;
    const auto row = [&](std::size_t i) {
        return relations.row(
            static_cast<RelationId>(i / label_count_), static_cast<Label>(i % label_count_)
        );
    };
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < rows; ++i) {
        pairs += count_labels(row(i));
    }
    pairs_per_label_ = label_count_ == 0 ? 0 : (pairs + label_count_ - 1) / label_count_;
    is_dense_ = pairs_per_label_ > kPairsMax;
    firsts_.resize(rows + 1);
    if (is_dense_) {
        return;
    }
    lists_.reserve(pairs);
    for (std::size_t i = 0; i < rows; ++i) {
        for_each_label(row(i), [&](Label other) { lists_.push_back(other); });
        firsts_[i + 1] = static_cast<std::uint32_t>(lists_.size());
    }
}

}  // namespace modelsynth
