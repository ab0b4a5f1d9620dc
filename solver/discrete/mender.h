#pragma once

#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"
#include "solver/discrete/box_search.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// Makes a model consistent that is so but for some places, by making a growing box around each of
// these anew.
// Requires: all arguments outlive it; `search` is one of the problem's.
class Mender {
  public:
    Mender(
        const Problem& problem, BoxSearch& search, std::uint64_t seed, const std::stop_token& stop
    )
        : problem_(problem), search_(search), seed_(seed), stop_(stop) {}

    // Mends the cells that have no label or one that their domain forbids, those that are not their
    // images', and beside a start the neighbours that do not fit.
    // Shape: a label a cell, or kNoLabel.
    // False: a box as large as the whole could not be made, or `stop` was requested.
    [[nodiscard]] bool mend(std::vector<Label>& model);

  private:
    // Takes away the labels that cannot stay; whether there is any cell without one.
    bool open(std::vector<Label>& model) const;
    void open_seam(std::vector<Label>& model) const;
    bool mend_around(std::vector<Label>& model, const Cell& centre);
    [[nodiscard]] Box box_around(const Cell& centre, std::int32_t reach) const;

    const Problem& problem_;
    BoxSearch& search_;
    std::uint64_t seed_;
    const std::stop_token& stop_;
};

}  // namespace modelsynth::discrete
