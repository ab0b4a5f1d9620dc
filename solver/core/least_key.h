#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth {

// A key for each of some places, and where the least one is: a tournament in which every node holds
// the smaller key of the two below it. Most changes of a key end a step or two up, where another
// key wins before and after; in a heap of entries each would leave a stale one behind.
//
// Cost: set() O(log places) at most, first_least() O(log places); 16 to 32 bytes a place.
class LeastKey {
  public:
    // Greater than every key: the place takes no part.
    static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};

    explicit LeastKey(std::size_t places)
        : leaves_(std::bit_ceil(std::max<std::size_t>(places, 1))), keys_(2 * leaves_, kNoKey) {}

    void set(std::size_t place, std::uint64_t key) {
        std::uint64_t* const keys = keys_.data();
        std::size_t node = leaves_ + place;
        keys[node] = key;
        while (node > 1) {
            const std::uint64_t least = std::min(keys[node], keys[node ^ 1]);
            node /= 2;
            if (keys[node] == least) {
                return;
            }
            keys[node] = least;
        }
    }

    [[nodiscard]] std::uint64_t least() const { return keys_[1]; }

    // Of the places with the least key the first. Requires: some place has a key.
    [[nodiscard]] std::size_t first_least() const {
        const std::uint64_t* const keys = keys_.data();
        std::size_t node = 1;
        while (node < leaves_) {
            node = 2 * node + std::size_t{keys[2 * node] != keys[1]};
        }
        return node - leaves_;
    }

  private:
    std::size_t leaves_;
    std::vector<std::uint64_t> keys_;  // of the root at 1, of the nodes below i at 2 i and 2 i + 1
};

}  // namespace modelsynth
