#include "solver/discrete/objective.h"

#include "solver/core/label_weights.h"
#include "solver/core/random.h"
#include "solver/discrete/names.h"
#include "solver/discrete/region.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace modelsynth::discrete {

namespace {

constexpr int kWhole = 255;

// What RandomKey::purpose says of the streams drawn here.
constexpr std::uint32_t kPurposeKeep = 5;

LabelSet members_of(const Example& example, const Term& term) {
    if (!term.pieces.empty()) {
        return set_of(labels_by_name(example), term.pieces);
    }
    LabelSet members = LabelSet::all(example.pieces.size());
    if (example.empty) {
        members.erase(*example.empty);
    }
    return members;
}

double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Whether an event of probability exp(-exponent) happens. By integer logarithms, since exp() may
// differ from machine to machine in its last digit.
bool happens(double exponent, RandomStream& random) {
    constexpr double kBitsPerNat = 1.4426950408889634;
    const std::uint64_t drawn = std::uint64_t{1} + random.next();  // of 2^32
    const std::uint32_t bits = (32U << 16) - fixed_log2(drawn);    // in units of 2^-16
    return exponent * kBitsPerNat * 65536 < static_cast<double>(bits);
}

}  // namespace

TermSum::TermSum(
    const Example& example, const GridSize& model, const Region& region, std::span<const Term> terms
)
    : model_(model), cells_by_floor_(static_cast<std::size_t>(model.y)) {
    const RegionCoverage coverage(region, model);
    coverage_.reserve(model.cell_count());
    for_each_cell(Box::whole(model), [&](const Cell& cell) {
        const auto covered = static_cast<std::uint8_t>(std::lround(kWhole * coverage.at(cell)));
        coverage_.push_back(covered);
        coverage_sum_ += covered;
        cells_by_floor_[static_cast<std::size_t>(cell.y)] += coverage.contains(cell) ? 1U : 0U;
    });
    for (const Term& term : terms) {
        states_.push_back(
            {term,
             members_of(example, term),
             std::vector<std::uint64_t>(static_cast<std::size_t>(model.y)),
             coverage_sum_}
        );
    }
}

void TermSum::start(std::span<const Label> model) {
    for (State& state : states_) {
        std::fill(state.by_floor.begin(), state.by_floor.end(), 0);
        state.mismatch = coverage_sum_;
    }
    for (std::size_t site = 0; site < model.size(); ++site) {
        change(static_cast<Site>(site), kNoLabel, model[site]);
    }
}

void TermSum::change(Site site, Label before, Label after) {
    for (State& state : states_) {
        put(state, site, before, -1);
        put(state, site, after, 1);
    }
}

double TermSum::value() const {
    return std::accumulate(
        states_.begin(),
        states_.end(),
        0.0,
        [this](double sum, const State& state) { return sum + state.term.weight * error(state); }
    );
}

void TermSum::put(State& state, Site site, Label label, int sign) const {
    if (!state.members.contains(label)) {
        return;
    }
    const int covered = coverage_[site];
    state.mismatch += sign * (kWhole - 2 * covered);
    if (2 * covered >= kWhole) {
        const auto floor = static_cast<std::size_t>(model_.cell(site).y);
        state.by_floor[floor] += static_cast<std::uint64_t>(static_cast<std::int64_t>(sign));
    }
}

double TermSum::error(const State& state) const {
    const std::uint64_t count =
        std::accumulate(state.by_floor.begin(), state.by_floor.end(), std::uint64_t{0});
    const auto against_target = [&](double value) {
        return state.term.target ? std::abs(value - *state.term.target) : -value;
    };
    switch (state.term.kind) {
        case Term::Kind::kDensity:
            return against_target(share(
                count,
                std::accumulate(cells_by_floor_.begin(), cells_by_floor_.end(), std::uint64_t{0})
            ));
        case Term::Kind::kCount:
            return against_target(static_cast<double>(count));
        case Term::Kind::kHeightProfile: {
            double sum = 0;
            const std::size_t floors = cells_by_floor_.size();
            for (std::size_t y = 0; y < floors; ++y) {
                const std::size_t of_profile =
                    (2 * y + 1) * state.term.profile.size() / (2 * floors);
                sum += std::abs(
                    share(state.by_floor[y], cells_by_floor_[y]) - state.term.profile[of_profile]
                );
            }
            return sum / static_cast<double>(floors);
        }
        case Term::Kind::kShape:
            return static_cast<double>(state.mismatch) /
                   (kWhole * static_cast<double>(coverage_.size()));
    }
    return 0;
}

Metropolis::Metropolis(const Example& example, const Parameters& parameters, std::uint64_t seed)
    : model_(*parameters.size), seed_(seed), sums_(term_sums<Objective>(example, parameters)) {
    for (const Constraint& constraint : parameters.constraints) {
        if (const auto* objective = std::get_if<Objective>(&constraint.rule)) {
            temperatures_.push_back(objective->temperature);
        }
    }
}

void Metropolis::start(std::span<const Label> model) {
    for (TermSum& sum : sums_) {
        sum.start(model);
    }
}

bool Metropolis::keeps(
    std::uint32_t block, const Box& box, std::span<const Label> before, std::span<const Label> model
) {
    std::vector<double> values;
    for (const TermSum& sum : sums_) {
        values.push_back(sum.value());
    }
    change(box, before, model, false);
    bool is_kept = true;
    double exponent = 0;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const double worse = sums_[i].value() - values[i];
        if (temperatures_[i] > 0) {
            exponent += worse / temperatures_[i];
        } else {
            is_kept = is_kept && worse <= 0;
        }
    }
    RandomStream random({seed_, block, 0, kPurposeKeep});
    is_kept = is_kept && (exponent <= 0 || happens(exponent, random));
    if (!is_kept) {
        change(box, before, model, true);
    }
    return is_kept;
}

double Metropolis::value() const {
    return std::accumulate(sums_.begin(), sums_.end(), 0.0, [](double total, const TermSum& sum) {
        return total + sum.value();
    });
}

void Metropolis::change(
    const Box& box, std::span<const Label> before, std::span<const Label> model, bool is_back
) {
    std::size_t i = 0;
    for_each_cell(box, [&](const Cell& cell) {
        const auto site = static_cast<Site>(model_.index(cell));
        const Label old = before[i++];
        if (old == model[site]) {
            return;
        }
        for (TermSum& sum : sums_) {
            sum.change(site, is_back ? model[site] : old, is_back ? old : model[site]);
        }
    });
}

}  // namespace modelsynth::discrete
