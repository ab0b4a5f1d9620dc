#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::discrete {

// Where a motion takes the directions of a grid, and with them the sides of a model. A translation
// leaves all as they are.
[[nodiscard]] std::array<Direction, kDirectionCount> direction_images(Symmetry::Kind kind);

// What an example says of its pieces, each a sentence that a motion may keep true: that one piece
// stands beside another, or that a piece may stand on a side that not all may stand on. The image
// of "b stands east of a" under a reflection in x is "the image of b stands west of that of a".
// Cost:  3 bits for each two pieces, some bytes a sentence.
// Thread-safe.
class PairImages {
  public:
    // Its boundary is the example's own. Requires: a boundary that names pieces of the example.
    PairImages(const Example& example, Symmetry::Kind kind);

    [[nodiscard]] std::size_t label_count() const { return pairs_of_.size(); }

    // Of the sentences.
    [[nodiscard]] std::size_t count() const { return pairs_.size(); }

    // The sentences that speak of a piece, in rising order.
    [[nodiscard]] std::span<const std::uint32_t> pairs_of(Label label) const {
        return pairs_of_[label];
    }

    // Whether the image of a sentence is true, too. Shape: images by label.
    [[nodiscard]] bool has_image(std::uint32_t pair, std::span<const Label> images) const;

    // How many pieces stand beside a piece in that direction.
    [[nodiscard]] std::uint32_t degree(Label label, std::size_t direction) const {
        return degrees_[label][direction];
    }

    [[nodiscard]] const std::array<Direction, kDirectionCount>& directions() const {
        return directions_;
    }

    // Numbers that tell the pieces apart by their neighbours, and these by theirs, so many steps
    // away. Those of the moved example are numbered as if it had been moved: where a map keeps all
    // pairs, what a piece has there is what its image has here.
    // Cost: O(steps * sentences).
    [[nodiscard]] std::vector<std::uint64_t> colours(bool is_moved, int steps) const;

  private:
    struct Pair {
        std::uint8_t place;  // an axis, or kAxisCount and the number of a side
        Label lower;
        Label upper;  // on a side: the piece again
    };

    static constexpr std::size_t kAxisCount = 3;

    void add_neighbours(std::size_t axis, Label lower, Label upper);
    void add_sides(const Example& example);

    [[nodiscard]] std::size_t bit(std::size_t axis, Label lower, Label upper) const {
        return (axis * pairs_of_.size() + lower) * pairs_of_.size() + upper;
    }

    std::array<Direction, kDirectionCount> directions_;
    std::vector<bool> are_neighbours_;
    std::vector<LabelSet> allowed_on_;  // by side
    std::vector<Pair> pairs_;
    std::vector<std::vector<std::uint32_t>> pairs_of_;
    std::vector<std::array<std::uint32_t, kDirectionCount>> degrees_;
};

}  // namespace modelsynth::discrete
