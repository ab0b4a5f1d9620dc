#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

// QuickXplain: Junker, "QUICKXPLAIN: preferred explanations and relaxations for over-constrained
// problems", AAAI 2004. See find_irreducible().
template <class Item, class IsConflict>
class QuickXplain {
  public:
    explicit QuickXplain(IsConflict is_conflict) : is_conflict_(std::move(is_conflict)) {}

    // Those of `items` that make a conflict with what is in held_ already.
    std::vector<Item> run(std::span<const Item> items, bool is_held_news) {
        if (is_held_news && is_conflict_(std::span<const Item>(held_))) {
            return {};
        }
        if (items.size() == 1) {
            return {items.front()};
        }
        const auto first = items.first(items.size() / 2);
        const auto second = items.subspan(items.size() / 2);
        std::vector<Item> of_second = with_held(first, second);
        std::vector<Item> found = with_held(of_second, first);
        found.insert(found.end(), of_second.begin(), of_second.end());
        return found;
    }

  private:
    std::vector<Item> with_held(std::span<const Item> more, std::span<const Item> items) {
        const std::size_t before = held_.size();
        held_.insert(held_.end(), more.begin(), more.end());
        std::vector<Item> found = run(items, !more.empty());
        held_.resize(before);
        return found;
    }

    IsConflict is_conflict_;
    std::vector<Item> held_;
};

// Of items that are in conflict, some that are, none of which can be left out; earlier ones rather
// than later ones. `is_conflict(std::span<const Item>)` tells whether a set is in conflict; where
// it says no without knowing, the set found is a conflict still, but some may be left out.
// Requires: the items together are in conflict, and what holds of a set holds of all larger ones.
// Cost:     k log2(n / k) + 2 k questions for k of n items, more or less.
template <class Item, class IsConflict>
[[nodiscard]] std::vector<Item> find_irreducible(
    std::span<const Item> items, IsConflict is_conflict
) {
    if (items.empty()) {
        return {};
    }
    return QuickXplain<Item, IsConflict>(std::move(is_conflict)).run(items, true);
}

}  // namespace modelsynth::discrete
