#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/core/topology.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace modelsynth::discrete {

// How far a model is from what the terms of one constraint ask for: the sum of their weights times
// their errors, kept up while cells change. The less the better; without a target, what there is
// of something counts as a negative error.
//
// Counts are whole numbers, so the sum depends on the model alone, not on how it came about.
// Cost: memory one byte a cell; change() O(terms). Not thread-safe.
class TermSum {
  public:
    // Requires: find_faults() found nothing. Starts with no cell holding anything.
    TermSum(
        const Example& example,
        const GridSize& model,
        const Region& region,
        std::span<const Term> terms
    );

    // Shape: as Example::cells.
    void start(std::span<const Label> model);

    // The label at a cell was another one; kNoLabel: none.
    void change(Site site, Label before, Label after);

    [[nodiscard]] double value() const;

  private:
    struct State {
        Term term;
        LabelSet members;
        std::vector<std::uint64_t> by_floor;  // members in the region
        std::int64_t mismatch = 0;            // of a shape, in 255ths of a cell
    };

    [[nodiscard]] double error(const State& state) const;
    void put(State& state, Site site, Label label, int sign) const;

    GridSize model_;
    std::vector<std::uint8_t> coverage_;         // of the region, by cell, 255 is all
    std::vector<std::uint64_t> cells_by_floor_;  // of the region
    std::int64_t coverage_sum_ = 0;
    std::vector<State> states_;
};

// The sums of all objectives or best_ofs of a request.
template <class Kind>
[[nodiscard]] std::vector<TermSum> term_sums(const Example& example, const Parameters& parameters) {
    std::vector<TermSum> sums;
    for (const Constraint& constraint : parameters.constraints) {
        if (const auto* kind = std::get_if<Kind>(&constraint.rule)) {
            sums.emplace_back(example, *parameters.size, constraint.region, kind->terms);
        }
    }
    return sums;
}

// Keeps or takes back each block by what it does to the objectives of a request (2007 paper, 4.2:
// with probability min(1, f(M') / f(M)), for f = exp(-sum / temperature)).
// Not thread-safe.
class Metropolis {
  public:
    Metropolis(const Example& example, const Parameters& parameters, std::uint64_t seed);

    // Whether the request has an objective at all.
    [[nodiscard]] bool is_asked_for() const { return !sums_.empty(); }

    void start(std::span<const Label> model);

    // Whether a block that changed a box is kept; the model counts from now on as it then is.
    // Shape: `before` has the labels that the box had, x fastest, then z, then y.
    [[nodiscard]] bool keeps(
        std::uint32_t block,
        const Box& box,
        std::span<const Label> before,
        std::span<const Label> model
    );

    // The sum over all objectives.
    [[nodiscard]] double value() const;

  private:
    void change(
        const Box& box, std::span<const Label> before, std::span<const Label> model, bool is_back
    );

    GridSize model_;
    std::uint64_t seed_;
    std::vector<TermSum> sums_;
    std::vector<double> temperatures_;
};

}  // namespace modelsynth::discrete
