#pragma once

#include "solver/core/grid.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::discrete {

// Why no model exists: what cannot hold together. Travels in Error::explanation.
struct Contradiction {
    struct NamedConstraint {
        std::size_t index = 0;  // among those of the request
        std::string kind;
    };

    struct NamedCell {
        Cell cell;
        std::vector<std::string> labels;  // all that the causes leave to it; few or none
    };

    // The causes. None at all: the example alone cannot fill the size.
    std::vector<std::string> sides;
    std::vector<NamedConstraint> constraints;
    std::vector<std::string> periodic;  // axes
    std::vector<std::string> removed;   // pieces of weight 0
    bool has_origin = false;            // what is kept of the model that this one starts from

    // Where it shows: were all other cells free to take any piece, these could not all take one of
    // theirs. Not all of them need be neighbours. Empty: it needs no cell, or too many to look at.
    std::vector<NamedCell> cells;

    // Proved: without any one of the causes there is a model.
    bool is_minimal = false;
};

// Where a search that gave up met its dead ends. Travels in Error::explanation.
struct DeadEnds {
    struct HotCell {
        Cell cell;
        std::uint32_t times = 0;  // > 0
    };

    std::vector<HotCell> hottest;  // the most often first
};

// The hottest cells, at most eight, of how often each cell of a grid was met.
// Shape: counts by cell.
[[nodiscard]] DeadEnds hottest_of(const GridSize& size, std::span<const std::uint32_t> counts);

}  // namespace modelsynth::discrete
