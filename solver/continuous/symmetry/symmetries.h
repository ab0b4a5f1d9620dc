#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/reading/reading.h"
#include "solver/core/graph_topology.h"
#include "solver/core/relations.h"
#include "solver/core/site_domains.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// The symmetries of a model, as relations and arcs beside those along edges: a vertex is joined to
// its image by a relation that allows each figure its own image alone.
// Thread-safe.
class Symmetries {
  public:
    // Requires: find_symmetry_fault() found nothing with any of the rules; at least one.
    Symmetries(
        const ExampleReading& reading,
        const Arrangement& arrangement,
        std::span<const SymmetryRule> rules,
        const std::array<double, 3>& size
    );

    // Those along edges, numbered as before, and two for every rule.
    [[nodiscard]] const Relations& relations() const { return relations_; }

    // The vertices and all their images, in rising order.
    [[nodiscard]] std::vector<Site> close(std::vector<Site> vertices) const;

    // Arcs from vertices of a part to their images, ends numbered as in the part.
    // Requires: the part is closed, in rising order.
    [[nodiscard]] std::vector<GraphArc> arcs(std::span<const Site> part) const;

    // How many figures of the example can stand nowhere, for want of an image.
    [[nodiscard]] std::size_t imageless() const;

    // Whether the vertex's image has the image of its figure. Shape: labels by vertex.
    [[nodiscard]] bool hold_at(Site vertex, std::span<const Label> labels) const;

    // Whether the images of other blocks fill all that lies beyond a corner of the model's box, so
    // that nothing need be made there by itself. Shape: metres.
    [[nodiscard]] bool is_filled_by_images(const Point& corner) const;

    // Takes figures that are not their own image from vertices that are theirs.
    void narrow(SiteDomains& domains) const;

  private:
    Symmetries(
        const Relations& along_edges,
        const Arrangement& arrangement,
        std::span<const SymmetryRule> rules,
        std::vector<std::vector<Label>> labels,
        const std::array<double, 3>& size
    );

    struct Generator {
        std::vector<Site> images;   // by vertex; kNoSite where the image is not in the box
        std::vector<Site> origins;  // the other way round
        std::vector<Label> labels;  // by figure; kNoLabel where the example has no such figure
        bool is_involution;
    };

    std::vector<SymmetryRule::Kind> kinds_;
    Point middle_;
    std::vector<Generator> generators_;
    Relations relations_;
};

}  // namespace modelsynth::continuous
