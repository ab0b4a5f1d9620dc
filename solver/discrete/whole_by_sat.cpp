#include "solver/discrete/whole_by_sat.h"

#include "solver/core/catalog.h"
#include "solver/discrete/problem_part.h"

#include <utility>

namespace modelsynth::discrete {

namespace {

constexpr SatLimits kLimits;

template <Topology T>
WholeBySat solve(
    const Problem& problem,
    const T& topology,
    const Relations& relations,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    const std::size_t cells = problem.size.cell_count();
    Catalog<T, 0> catalog(topology, relations);
    std::vector<std::uint16_t> tables(cells);
    std::vector<Word> sets;
    sets.reserve(catalog.all_labels().size());
    for (std::size_t i = 0; i < cells; ++i) {
        const auto site = static_cast<Site>(i);
        const auto own = problem.domains.words(site);
        sets.insert(sets.end(), own.begin(), own.end());
        tables[i] = problem.weights.number(site);
    }
    catalog.restore(sets);
    catalog.enqueue_all();
    switch (catalog.propagate(stop)) {
        case Propagation::kConsistent:
            break;
        case Propagation::kContradiction:
            return {{SatOutcome::kImpossible}, {}};
        case Propagation::kStopped:
            return {{SatOutcome::kStopped}, {}};
    }
    WholeBySat whole;
    whole.labels.resize(cells);
    whole.result = solve_by_sat(
        topology,
        relations,
        catalog.all_labels(),
        {problem.weights, tables},
        {seed},
        kLimits,
        stop,
        whole.labels
    );
    return whole;
}

}  // namespace

WholeBySat solve_whole_by_sat(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
) {
    if (problem.size.cell_count() > kLimits.literals_max) {
        return {};
    }
    const Box whole = Box::whole(problem.size);
    return with_part(problem, whole, [&](const auto& part, const Relations& relations) {
        return solve(problem, part.inner(), relations, seed, stop);
    });
}

Result<std::optional<std::vector<Label>>> settle_by_sat(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
) {
    WholeBySat whole = solve_whole_by_sat(problem, seed, stop);
    switch (whole.result.outcome) {
        case SatOutcome::kImpossible:
            return tl::unexpected(Error{
                ErrorCode::kContradiction,
                "no model of this size exists: that is proved, but not understood",
                {}});
        case SatOutcome::kStopped:
            return tl::unexpected(Error{ErrorCode::kCancelled, "stopped", {}});
        case SatOutcome::kSolved:
            return std::optional(std::move(whole.labels));
        case SatOutcome::kGaveUp:
            break;
    }
    return std::optional<std::vector<Label>>();
}

}  // namespace modelsynth::discrete
