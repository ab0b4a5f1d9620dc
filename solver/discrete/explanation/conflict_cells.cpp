#include "solver/discrete/explanation/conflict_cells.h"

#include "solver/core/catalog.h"
#include "solver/core/constraints/constraint_board.h"
#include "solver/core/sat/label_formula.h"
#include "solver/core/sat/sat_search.h"
#include "solver/core/topology.h"
#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/explanation/irreducible.h"
#include "solver/discrete/problem_part.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace modelsynth::discrete {

namespace {

// A cell whose domain says anything.
struct Narrowed {
    Site inside = 0;  // of the part
    Site whole = 0;
};

// Propagation in a part whose surroundings are open, while only some of its cells are held to what
// their domains say. In the whole the member rules take part.
template <TopologyPart Part>
class PartPropagation {
  public:
    PartPropagation(
        const Problem& problem,
        const LabelSet& everything,
        const Part& part,
        const Relations& relations,
        const std::stop_token& stop
    )
        : problem_(problem), part_(part), catalog_(part_.inner(), relations), stop_(stop) {
        if (catalog_.site_count() == problem.size.cell_count() && !problem.member_rules.empty()) {
            board_ = make_board(problem, problem.member_rules);
            open_.assign(problem.size.cell_count(), kNoLabel);
            board_->start(open_);
        }
        catalog_.fill(everything.words());
        catalog_.enqueue_all();
        is_open_consistent_ = catalog_.propagate(stop) == Propagation::kConsistent;
        base_.assign(catalog_.all_labels().begin(), catalog_.all_labels().end());
        for_each_site(part_, [&](Site inside, Site whole) {
            if (!(problem.domains.at(whole) == everything)) {
                narrowed_.push_back({inside, whole});
            }
        });
    }

    [[nodiscard]] const std::vector<Narrowed>& narrowed() const { return narrowed_; }

    [[nodiscard]] bool is_conflict(std::span<const Narrowed> held) {
        if (!is_open_consistent_) {
            return true;
        }
        catalog_.restore(base_);
        for (const Narrowed& cell : held) {
            if (!catalog_.narrow(cell.inside, problem_.domains.words(cell.whole).data())) {
                return true;
            }
        }
        Propagation propagation = catalog_.propagate(stop_);
        if (board_ != nullptr && propagation == Propagation::kConsistent) {
            board_->enter(part_);
            propagation = board_->begin(catalog_, stop_);
            board_->leave(open_);
        }
        return propagation == Propagation::kContradiction;
    }

  private:
    const Problem& problem_;
    const Part& part_;
    Catalog<typename Part::Inner, 0> catalog_;
    const std::stop_token& stop_;
    std::unique_ptr<ConstraintBoard> board_;
    std::vector<Label> open_;
    std::vector<Word> base_;
    bool is_open_consistent_ = true;
    std::vector<Narrowed> narrowed_;
};

Box box_around(const GridSize& size, const Cell& centre, std::int32_t reach) {
    const auto range = [reach](std::int32_t at, std::int32_t extent) {
        return std::pair(std::max(0, at - reach), std::min(extent, at + reach + 1));
    };
    const auto [west, east] = range(centre.x, size.x);
    const auto [bottom, top] = range(centre.y, size.y);
    const auto [north, south] = range(centre.z, size.z);
    return {{west, bottom, north}, {east, top, south}};
}

// Nothing when propagation sees no conflict.
template <TopologyPart Part>
std::optional<std::vector<Site>> find_by_propagation(
    const Problem& problem,
    const LabelSet& everything,
    const Part& part,
    const Relations& relations,
    Effort& effort,
    const std::stop_token& stop
) {
    PartPropagation<Part> propagation(problem, everything, part, relations, stop);
    const std::size_t cells = part.inner().site_count();
    const auto is_conflict = [&](std::span<const Narrowed> held) {
        return effort.take(cells) && propagation.is_conflict(held);
    };
    const std::span<const Narrowed> all = propagation.narrowed();
    if (!is_conflict(all)) {
        return std::nullopt;
    }
    std::vector<Site> sites;
    for (const Narrowed& cell : find_irreducible(all, is_conflict)) {
        sites.push_back(cell.whole);
    }
    return sites;
}

// By CaDiCaL: a guard for each cell whose domain says anything. The core of the first proof leaves
// few of them.
template <Topology T>
std::vector<Site> find_by_sat(
    const Problem& problem,
    const LabelSet& everything,
    const T& topology,
    const Relations& relations,
    Effort& effort,
    const std::stop_token& stop
) {
    using Guard = LabelFormula::Guard;
    constexpr SatLimits kLimits;
    Catalog<T, 0> catalog(topology, relations);
    catalog.fill(everything.words());
    catalog.enqueue_all();
    if (catalog.propagate(stop) != Propagation::kConsistent) {
        return {};
    }
    LabelFormula formula(relations, catalog.all_labels(), kLimits.literals_max, 0);
    formula.add_arcs(topology);
    if (formula.is_too_large() || !effort.take(formula.literal_count())) {
        return {};
    }
    std::vector<std::pair<Guard, Site>> guards;
    for (std::size_t i = 0; i < problem.size.cell_count(); ++i) {
        const auto site = static_cast<Site>(i);
        if (!(problem.domains.at(site) == everything)) {
            guards.emplace_back(formula.narrow_if_assumed(site, problem.domains.words(site)), site);
        }
    }
    const auto is_conflict = [&](std::span<const std::pair<Guard, Site>> held) {
        std::vector<Guard> assumed;
        for (const auto& [guard, site] : held) {
            assumed.push_back(guard);
        }
        const std::uint64_t before = formula.conflict_count();
        const bool is_proved =
            effort.take(problem.size.cell_count()) &&
            formula.solve(assumed, kLimits.conflicts_max, stop) == CnfOutcome::kUnsatisfiable;
        effort.spend(kConflictEffort * (formula.conflict_count() - before));
        return is_proved;
    };
    if (!is_conflict(guards)) {
        return {};
    }
    std::erase_if(guards, [&](const auto& entry) { return !formula.is_in_core(entry.first); });
    std::vector<Site> sites;
    for (const auto& [guard, site] :
         find_irreducible(std::span<const std::pair<Guard, Site>>(guards), is_conflict)) {
        sites.push_back(site);
    }
    return sites;
}

}  // namespace

std::vector<Site> find_conflict_cells(
    const Problem& problem,
    const LabelSet& everything,
    std::optional<Site> emptied,
    Effort& effort,
    const std::stop_token& stop
) {
    const Box whole = Box::whole(problem.size);
    std::vector<Site> sites;
    const auto look_in = [&](const Box& box) {
        auto found = with_part(problem, box, [&](const auto& part, const Relations& relations) {
            return find_by_propagation(problem, everything, part, relations, effort, stop);
        });
        sites = found ? std::move(*found) : std::vector<Site>();
        return found.has_value();
    };
    bool found = false;
    if (emptied && problem.member_rules.empty()) {
        const Cell centre = problem.size.cell(*emptied);
        Box box = box_around(problem.size, centre, 0);
        for (std::int32_t reach = 1; !(found = look_in(box)) && box != whole; reach *= 2) {
            box = box_around(problem.size, centre, reach);
        }
    } else {
        found = look_in(whole);
    }
    if (!found) {
        sites = with_part(problem, whole, [&](const auto& part, const Relations& relations) {
            return find_by_sat(problem, everything, part.inner(), relations, effort, stop);
        });
    }
    std::sort(sites.begin(), sites.end());
    return sites;
}

}  // namespace modelsynth::discrete
