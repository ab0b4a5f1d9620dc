#pragma once

#include "solver/continuous/arrangement.h"
#include "solver/continuous/figures.h"
#include "solver/continuous/parameters.h"
#include "solver/core/graph_topology.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"
#include "solver/core/site_domains.h"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A rigid motion of a model onto itself: p goes to turn * p + shift.
struct Motion {
    Eigen::Matrix3d turn;  // a signed permutation of the axes that leaves y
    Point shift;           // metres
};

[[nodiscard]] Motion motion_of(const SymmetryRule& rule, const std::array<double, 3>& size);

// How often a reflection or turn has to be made until all is as before; 0: never.
[[nodiscard]] std::size_t order_of(SymmetryRule::Kind kind);

// What is wrong with a symmetry, if anything is: faces without images, planes whose image lies
// between planes, objects whose images are no one-to-one map or do not come back.
// Shape: `planes` has the offsets of every family's planes. Requires: the objects are known.
struct SymmetryFault {
    std::string field;  // of the constraint, "/rotate"
    std::string detail;
};

[[nodiscard]] std::optional<SymmetryFault> find_symmetry_fault(
    const Example& example,
    const Topes& topes,
    const SymmetryRule& rule,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
);

// The symmetries of a model, as relations and arcs beside those along edges: a vertex is joined to
// its image by a relation that allows each figure its own image alone.
// Thread-safe.
class Symmetries {
  public:
    // Requires: find_symmetry_fault() found nothing with any of the rules; at least one.
    Symmetries(
        const Example& example,
        const Figures& figures,
        const Relations& along_edges,
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

    // Takes figures that are not their own image from vertices that are theirs.
    void narrow(SiteDomains& domains) const;

  private:
    struct Generator {
        std::vector<Site> images;   // by vertex; kNoSite where the image is not in the box
        std::vector<Site> origins;  // the other way round
        std::vector<Label> labels;  // by figure; kNoLabel where the example has no such figure
        bool is_involution;
    };

    std::vector<Generator> generators_;
    Relations relations_;
};

}  // namespace modelsynth::continuous
