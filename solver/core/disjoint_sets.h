#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace modelsynth {

// Disjoint sets of the numbers from 0 on (union-find with halved paths). Each is named by its least
// member, so that names depend on the sets alone.
// Cost: O(log n) a call. Thread-safety: one thread at a time.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0U);
    }

    // The least member of a number's set.
    [[nodiscard]] std::uint32_t find(std::size_t member) {
        auto at = static_cast<std::uint32_t>(member);
        while (parents_[at] != at) {
            parents_[at] = parents_[parents_[at]];
            at = parents_[at];
        }
        return at;
    }

    void join(std::size_t a, std::size_t b) {
        const std::uint32_t of_a = find(a);
        const std::uint32_t of_b = find(b);
        parents_[std::max(of_a, of_b)] = std::min(of_a, of_b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace modelsynth
