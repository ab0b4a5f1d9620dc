#pragma once

#include "solver/continuous/constraints/connections.h"
#include "solver/continuous/origin.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/planes/spacing.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/symmetry/symmetries.h"
#include "solver/core/kind_relations.h"
#include "solver/core/result.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

inline constexpr std::size_t kVerticesMax = 2'000'000;

// A request as sites, labels and relations. Thread-safe.
struct Problem {
    std::shared_ptr<const ExampleReading> reading;
    Spacings spacings;
    Bounds box;  // of the model; that of the arrangement may be larger
    Arrangement arrangement;
    SiteDomains domains;
    SiteWeights weights;
    std::unique_ptr<const KindRelations> by_kind;  // of all these; null: there is none
    // Empty space, or the bare ground, or the model to start from, but for what constraints ask
    // for: consistent from the beginning, and what stands at the border of the model for good.
    std::vector<Label> initial;
    std::vector<std::uint8_t> is_kept;  // by vertex: 1 where the initial label stays; or nothing
    // Figures of the example that no vertex of the model can have.
    std::vector<Label> homeless;
    std::vector<Connection> connections;
    std::unique_ptr<const Symmetries> symmetries;  // null: none
    double perturbation = 0;                       // metres by which faces may be moved
    std::vector<FamilySet> stiff;  // by object: the families across which it has a dimension

    // Along edges, and to images.
    [[nodiscard]] const Relations& relations() const {
        return symmetries ? symmetries->relations() : reading->relations();
    }
};

// Requires: every parameter has a value, and find_faults() finds nothing.
// What is asked for is asked of the whole model: a kept label that constraints do not allow is a
// contradiction.
// Fails: kTooLarge, kInvalidArgument; see Arrangement::make() and make_weights(); kContradiction,
// kGaveUp; see find_initial_labels(); as place_origin(); kCancelled when `stop` is requested.
[[nodiscard]] Result<Problem> make_problem(
    std::shared_ptr<const ExampleReading> reading,
    const Parameters& parameters,
    const Origin* origin = nullptr,
    const std::stop_token& stop = {}
);

}  // namespace modelsynth::continuous
