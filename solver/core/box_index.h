#pragma once

#include "solver/core/grid.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// Numbered boxes of a model by where they are, so that those that meet one are found among few.
// Cost: O(boxes near by) each, and a vector for each of up to 64 places along every axis.
// Not thread-safe.
class BoxIndex {
  public:
    // None of `boxes` is added yet. Requires: no other ones are ever added or asked about.
    BoxIndex(const GridSize& model, std::span<const Box> boxes);

    void add(std::uint32_t number, const Box& box);

    // Requires: it was added (checked).
    void remove(std::uint32_t number, const Box& box);

    // Calls visit(std::uint32_t number) once for every box added that meets this one, on whichever
    // axes the model is periodic (see blocks_meet()), and for some that do not.
    template <class Visit>
    void for_each_near(const Box& box, Visit visit) const {
        const Cell place = place_of(box);
        const auto around_x = around(place.x, counts_.x);
        for (const std::int32_t y : around(place.y, counts_.y)) {
            for (const std::int32_t z : around(place.z, counts_.z)) {
                for (const std::int32_t x : around_x) {
                    if (x >= 0 && y >= 0 && z >= 0) {
                        for (const std::uint32_t number : places_[counts_.index({x, y, z})]) {
                            visit(number);
                        }
                    }
                }
            }
        }
    }

  private:
    // The place and those beside it, round the axis; -1 for those that it has not.
    static std::array<std::int32_t, 3> around(std::int32_t place, std::int32_t count) {
        return {
            place,
            count > 1 ? (place + 1) % count : -1,
            count > 2 ? (place + count - 1) % count : -1};
    }

    [[nodiscard]] Cell place_of(const Box& box) const;

    GridSize model_;
    GridSize counts_;  // of places along each axis, all wider than any box
    std::vector<std::vector<std::uint32_t>> places_;
};

}  // namespace modelsynth
