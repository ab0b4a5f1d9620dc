#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// Intervals of numbers, and which of them meet another one: a balanced tree in an array sorted by
// the lower ends, the root of a range in its middle, that knows the highest end below each root.
class IntervalTree {
  public:
    struct Interval {
        double low = 0;
        double high = 0;
        std::size_t item = 0;
    };

    IntervalTree() = default;

    explicit IntervalTree(std::vector<Interval> intervals) : intervals_(std::move(intervals)) {
        std::sort(intervals_.begin(), intervals_.end(), [](const Interval& a, const Interval& b) {
            return a.low != b.low ? a.low < b.low : a.item < b.item;
        });
        highest_.resize(intervals_.size());
        find_highest(0, intervals_.size());
    }

    // Calls visit(item) for all that meet the range, ends included, by their lower ends.
    // Cost: O(log n) and O(log n) for each of them at worst.
    template <class Visit>
    void for_each(double low, double high, const Visit& visit) const {
        descend(0, intervals_.size(), low, high, visit);
    }

  private:
    double find_highest(std::size_t first, std::size_t end) {
        const std::size_t root = first + (end - first) / 2;
        if (first == end) {
            return -1e300;
        }
        highest_[root] =
            std::max({intervals_[root].high, find_highest(first, root), find_highest(root + 1, end)}
            );
        return highest_[root];
    }

    template <class Visit>
    void descend(std::size_t first, std::size_t end, double low, double high, const Visit& visit)
        const {
        const std::size_t root = first + (end - first) / 2;
        if (first == end || highest_[root] < low) {
            return;
        }
        descend(first, root, low, high, visit);
        if (intervals_[root].low > high) {
            return;
        }
        if (intervals_[root].high >= low) {
            visit(intervals_[root].item);
        }
        descend(root + 1, end, low, high, visit);
    }

    std::vector<Interval> intervals_;
    std::vector<double> highest_;  // by root, of all below it
};

}  // namespace modelsynth::continuous
