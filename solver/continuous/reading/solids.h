#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/reading/families.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth::continuous {

// Tells which object of an example a point lies in, and how far its faces are.
// Requires: the example outlives it, and its solids are closed. Cost: O(faces) a question.
// Thread-safe.
class Solids {
  public:
    explicit Solids(const Example& example);

    // The object at a point that lies on no face. Of solids that overlap the last one counts; below
    // y = 0 the ground where there is no solid.
    [[nodiscard]] ObjectId at(const Point& point) const;

    // Distance from the point to a face; 0 on it.
    [[nodiscard]] double distance(std::size_t solid, std::size_t face, const Point& point) const;

    // How often the solid goes round the point: 1 inside of it, 0 outside, nearly so for any point
    // that is not on a face.
    [[nodiscard]] double winding(std::size_t solid, const Point& point) const;

  private:
    struct Box {
        Point min;
        Point max;
    };

    const Example& example_;
    std::vector<Box> boxes_;
};

}  // namespace modelsynth::continuous
