#pragma once

#include "solver/core/graph_topology.h"
#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"
#include "solver/core/label_images.h"
#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/discrete/parameters.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

// A map of a model's cells, and of labels, onto themselves: where label k stands at a cell, its
// image k' stands at the cell's image (S of the 2007 paper, 4.1; T_s of thesis 3.5.2).
class CellMap {
  public:
    // The cells that the symmetry speaks of are those of the region that have their image in it: in
    // a box, if that is all of the region, about its middle; else about the model's.
    // Requires: find_symmetry_fault() found nothing.
    CellMap(
        const Symmetry& symmetry, const Region& region, const GridSize& model, Periodic periodic
    );

    // Nothing where the symmetry says nothing of the cell.
    [[nodiscard]] std::optional<Site> image(Site site) const { return moved(site, false); }

    [[nodiscard]] std::optional<Site> preimage(Site site) const { return moved(site, true); }

    // Whether the image of the image is the cell itself.
    [[nodiscard]] bool is_involution() const { return is_involution_; }

  private:
    [[nodiscard]] std::optional<Site> moved(Site site, bool backwards) const;

    Symmetry::Kind kind_;
    Cell translation_;
    GridSize model_;
    Periodic periodic_;
    Box about_;
    bool is_involution_;
    std::vector<std::uint8_t> applies_;  // by cell; empty: everywhere
};

// How often the cells have to be moved until all are back; 0: never for a translation.
[[nodiscard]] std::size_t order_of(Symmetry::Kind kind);

// What is wrong with a symmetry, and with which of its fields ("/rotate"): a quarter turn of what
// is not as wide as deep, images that are no one-to-one map or do not come back as the cells do.
// Requires: the region's box lies in the model; every piece that `mirror` names is known.
struct SymmetryFault {
    std::string field;
    std::string detail;
};

[[nodiscard]] std::optional<SymmetryFault> find_symmetry_fault(
    const Symmetry& symmetry,
    const Region& region,
    const GridSize& model,
    std::size_t label_count,
    std::span<const std::pair<Label, Label>> given
);

// The symmetries of a problem, as relations and arcs beside those of the grid: a cell is joined to
// its image by a relation that allows each label its own image alone.
// Thread-safe.
class Symmetries {
  public:
    struct Generator {
        CellMap cells;
        std::vector<Label> labels;  // by label, its image
    };

    // Requires: at least one generator (checked).
    Symmetries(
        const GridSize& size,
        Periodic periodic,
        const Relations& of_grid,
        std::vector<Generator> generators
    );

    // Those of the grid, numbered as before, and two for every generator.
    [[nodiscard]] const Relations& relations() const { return relations_; }

    // The box's cells and all their images.
    // Cost: O(cells of it).
    [[nodiscard]] GraphPart close(const Box& box) const;

    // The labels that may stand at a cell that is its own image.
    // Shape: of all labels where it is not.
    [[nodiscard]] LabelSet allowed_at(Site site) const;

    // Whether a label is its own image under all of them.
    [[nodiscard]] bool is_own_image(Label label) const;

    // Whether two cells of the model, complete as far as it goes, are not each other's images.
    // Shape: a label a cell; kNoLabel says nothing.
    [[nodiscard]] bool is_violated_at(std::span<const Label> model, Site site) const;

  private:
    GridTopology whole_;
    Relations relations_;
    std::vector<Generator> generators_;
};

}  // namespace modelsynth::discrete
