#pragma once

#include "solver/core/grid_topology.h"
#include "solver/core/label_chooser.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"
#include "solver/discrete/example.h"
#include "solver/discrete/origin.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/symmetries.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace modelsynth::discrete {

// The transition matrices T_x, T_y, T_z of the example (Eq. 3.2) and their transposes: a relation
// per direction. Exactly the pairs that stand in the example, and those listed in `adjacency`.
[[nodiscard]] Relations find_transitions(const Example& example);

// The labels that may be used at all: those that stand in the example or its `adjacency`, less
// those of weight 0. Shape: a weight for every piece.
[[nodiscard]] LabelSet usable_labels(const Example& example, const std::vector<double>& weights);

// A constraint on the cells whose piece is one of a set: what cannot be said of a cell by itself.
struct MemberRule {
    std::size_t constraint = 0;  // its number in the parameters
    Rule rule;
    LabelSet labels;
    std::vector<std::uint8_t> applies;  // by cell; empty: everywhere
};

// The model that another one starts from, in the place that it has there.
// Shape: by cell of the model to make.
struct Start {
    std::vector<Label> labels;          // kNoLabel: it has none there
    std::vector<std::uint8_t> is_kept;  // the label stays
};

// A request as the search sees it.
struct Problem {
    GridSize size;
    Periodic periodic;
    Relations relations;
    SiteDomains domains;  // boundary, fixed and forbidden cells, removed pieces, what is kept
    SiteWeights weights;  // table 0: those without the constraints
    std::vector<MemberRule> member_rules;
    std::unique_ptr<const GridTopology> topology;  // of the whole, where a member rule needs it
    std::unique_ptr<const Symmetries> symmetries;  // null: none
    std::unique_ptr<const LabelChooser> chooser;   // null: labels are drawn by weight alone
    std::optional<Start> start;
    ScanAxes scan_axes = kColumns;
};

// What is kept of the model that another one starts from is fixed.
void narrow_to_kept(const Start& start, SiteDomains& domains);

// Requires: find_faults() found nothing (checked); the origin, if any, lies in the model.
// Ensures:  nothing of the domains: some cell may be able to take no piece at all.
// Fails:    kTooLarge for too many tables of weights.
[[nodiscard]] Result<Problem> read_problem(
    const Example& example, const Parameters& parameters, const Origin* origin = nullptr
);

// The same, with something for every cell to take.
// Fails:    kContradiction when some cell can take no piece at all; the message names the sides.
//           kTooLarge as read_problem().
[[nodiscard]] Result<Problem> make_problem(
    const Example& example, const Parameters& parameters, const Origin* origin = nullptr
);

}  // namespace modelsynth::discrete
