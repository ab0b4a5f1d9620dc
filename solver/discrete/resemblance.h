#pragma once

#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"
#include "solver/core/label_chooser.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::discrete {

// What one choice may cost: see resemblance_cost().
inline constexpr std::size_t kResemblanceCostMax = 8'000'000;

// The example's cells times those of a window.
[[nodiscard]] std::size_t resemblance_cost(const Example& example, const Resemblance& resemblance);

// Chooses label k with a probability in proportion to L(k): in how many places of the example k
// stands in surroundings that differ from those decided so far in no more cells than a threshold
// allows (2007 paper, 3.3, Eq. 2-6). The threshold d_0 is the smallest difference found plus
// Resemblance::threshold, since the paper normally sets it at the smallest.
//
// Where the paper's windows are cut off at the edge of the example, and so differ the less, cells
// beyond an edge count here as a label of their own: what stands at the edge of the example is like
// what stands at the edge of the model. Cells that are not decided differ from all alike. Where
// constraints weigh labels by place, L(k) is multiplied by what they make of the label's weight.
// Cost: a choice O(places of the labels possible * decided cells in the window).
class ResemblanceChooser final : public LabelChooser {
  public:
    // `usual`: the weights where no constraint changes them.
    // Requires: the example has cells (checked).
    ResemblanceChooser(
        const Example& example,
        const Resemblance& resemblance,
        const GridSize& model,
        Periodic periodic,
        const LabelWeights& usual
    );

    void look_around(Site site, std::vector<Site>& around) const override;

    [[nodiscard]] Label choose(
        std::span<const Word> possible,
        std::span<const Site> around,
        std::span<const Label> decided,
        const LabelWeights& weights,
        RandomStream& random
    ) const override;

  private:
    struct DecidedCell {
        std::ptrdiff_t step;  // from a cell of the example to the one that it is set against
        Label label;          // kNoLabel: beyond the model's edge
    };

    GridSize model_;
    Periodic periodic_;
    std::int32_t threshold_;
    const LabelWeights usual_;
    std::vector<Cell> offsets_;                     // of a window's cells from its middle
    std::vector<std::ptrdiff_t> steps_;             // the same in the example
    std::vector<Label> example_;                    // with a margin of kNoLabel as wide as a window
    std::vector<std::vector<std::size_t>> places_;  // by label, where it stands there
};

}  // namespace modelsynth::discrete
