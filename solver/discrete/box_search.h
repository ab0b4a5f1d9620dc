#pragma once

#include "solver/core/block_bases.h"
#include "solver/core/block_search.h"
#include "solver/core/graph_topology.h"
#include "solver/core/grid_topology.h"
#include "solver/core/layered_relations.h"
#include "solver/discrete/problem.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

struct BoxOptions {
    // A cell of the box that has to take one of some labels.
    struct Pin {
        Cell cell;
        const LabelSet* labels = nullptr;
    };

    std::uint32_t attempts = 8;
    Order order = Order::kScan;
    // As of BlockOptions; null: the problem's member rules are not asked.
    ConstraintBoard* board = nullptr;
    std::optional<Pin> pin = std::nullopt;
    const LabelChooser* chooser = nullptr;  // as of BlockOptions
    // As of BlockOptions, for the whole alone: by cell of it.
    std::span<std::uint32_t> dead_ends = {};
    std::optional<SatLimits> by_sat = std::nullopt;  // as of BlockOptions
    std::span<const Label> usual = {};               // as of BlockOptions
};

// Makes boxes of a problem's models anew, whatever else has to change with them: the images of
// their cells under the problem's symmetries.
// Not thread-safe; one per thread. Requires: the problem outlives it.
class BoxSearch {
  public:
    using Bases = BlockBases<GridTopology>;

    // `bases` and `by_kind` as of BlockSearch.
    explicit BoxSearch(
        const Problem& problem, Bases* bases = nullptr, const LayeredRelations* by_kind = nullptr
    );

    // As BlockSearch::modify(), for the box and its images.
    [[nodiscard]] BlockResult modify(
        const Box& box,
        std::span<Label> model,
        const BoxOptions& options,
        const RandomKey& key,
        const std::stop_token& stop
    );

    // As BlockSearch::is_determined().
    [[nodiscard]] bool is_determined(
        const Box& box, std::span<const Label> model, const std::stop_token& stop
    );

    // Tells a board that the box and its images have other labels than modify() left.
    void note_change(const Box& box, std::span<const Label> model, ConstraintBoard& board) const;

    // The smallest box that holds all that modify() may change.
    [[nodiscard]] Box touched(const Box& box) const;

    [[nodiscard]] std::size_t largest_part() const;

  private:
    [[nodiscard]] const GridPart& part_of(const Box& box);
    // The box's cells in the order of the problem's scan, as numbers in the box.
    [[nodiscard]] std::span<const Site> scan_of(const GridSize& shape);

    const Problem& problem_;
    BlockSearch<GridPart> on_grid_;
    std::optional<BlockSearch<GraphPart>> on_graph_;  // where there are symmetries
    std::optional<GridPart> part_;                    // the last one: most have the same shape
    std::vector<Site> scan_;
    GridSize scan_shape_;
};

}  // namespace modelsynth::discrete
