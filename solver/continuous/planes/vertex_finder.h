#pragma once

#include "solver/continuous/planes/arrangement.h"

namespace modelsynth::continuous {

// Finds vertices of an arrangement by where they are. Thread-safe.
class VertexFinder {
  public:
    // Requires: the arrangement outlives it.
    explicit VertexFinder(const Arrangement& arrangement) : arrangement_(arrangement) {}

    // The vertex within a millionth of a cell of the place; kNoSite where there is none.
    [[nodiscard]] Site at(const Point& place) const;

  private:
    const Arrangement& arrangement_;
};

}  // namespace modelsynth::continuous
